// SPDX-License-Identifier: MIT
#pragma once
// Does what directors want between two ticks (docs/protocol.md, section 9.1).

#include <chrono>
#include <cstddef>
#include <optional>
#include <string>

#include "network/server.h"
#include "reports/console.h"
#include "reports/summary.h"
#include "supervision/callers.h"
#include "supervision/population.h"
#include "supervision/world.h"

namespace ziggurat::supervision {

class Directing {
 public:
  /// Everything must outlive this. From now on each Direction is checked before it is taken.
  Directing(World& world, network::Server& server, Callers& callers, Population& population,
            reports::Console& console);

  /// The tick is complete: a director ends the run with it. Of several the first by id counts.
  std::optional<reports::Summary::Result> result() const;
  /// The tick is complete, and not the last: does all acts, director by director in the order of
  /// their ids. One that can't be done, because another has changed the world before, is left out,
  /// and its director is told.
  void act();
  /// A director subscribed to contacts.
  bool wants_contacts() const { return directors_.wants_contacts(); }

 private:
  class Names;
  class Floor;
  std::optional<wire::Fault> check(const wire::Direction& direction) const;
  std::optional<wire::Fault> apply(const wire::DirectorAct& act, Names& names, Floor& floor);
  void note_left_out(const std::string& director, const std::string& why);

  World& world_;
  network::ServerDirectors directors_;
  Callers& callers_;
  Population& population_;
  reports::Console& console_;
  std::size_t untold_ = 0;  ///< acts that were left out since the last notice on one
  std::chrono::steady_clock::time_point next_notice_{};
};

}  // namespace ziggurat::supervision
