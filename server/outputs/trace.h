// SPDX-License-Identifier: MIT
#pragma once
// World poses of all links over time: `--trace`, a CSV file.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "outputs/output_file.h"
#include "world/layout.h"
#include "world/state.h"

namespace ziggurat::outputs {

/// Columns `tick,time_s,entity,link,x,y,z,qw,qx,qy,qz`: poses X_WE and X_WL of the bottom-centre
/// frames, [m] and unit quaternions, in digits that read back to the same double. Per tick and
/// entity, in scene order: a row of its origin with an empty link, then one for each link if the
/// entity lists its links.
class Trace {
 public:
  /// Keeps a reference to `layout`. @throws WriteError
  Trace(std::string path, const world::Layout& layout);

  /// Without rows of what is absent. @throws WriteError
  void write(const world::State& state);
  /// The layout is of another world now: its rows are named again.
  void name_anew();
  void flush() { file_.flush(); }  ///< @throws WriteError
  void close() { file_.close(); }

 private:
  void name_rows(const world::State& state);

  struct Row {
    std::string names;  ///< `,entity,link,` as it stands in the file
    std::size_t entity;
    std::optional<std::size_t> link;  ///< none: the origin of the entity
  };

  const world::Layout& layout_;
  std::size_t entities_ = 0;     // that have rows
  std::uint64_t last_tick_ = 0;  // that was written
  std::vector<Row> rows_;
  OutputFile file_;
};

}  // namespace ziggurat::outputs
