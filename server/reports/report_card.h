#pragma once
// How fast each controller answered: a histogram, misses, the worst ticks, and whether the gate was
// met.

#include <string>
#include <vector>

#include "network/delays.h"
#include "network/latencies.h"
#include "reports/gate.h"

namespace ziggurat::reports {

struct ControllerCard {
  std::string controller;         ///< id in the scene
  network::Latencies latencies;   ///< from observation to command
  std::uint64_t misses = 0;       ///< ticks at which a robot of it missed its deadline
  network::Injection injected{};  ///< delays and losses of its messages
  network::Lost lost{};           ///< messages lost by the injection
};

struct ReportCard {
  std::vector<ControllerCard> controllers;  ///< in scene order
  std::uint64_t ticks = 0;
  std::uint64_t late_ticks = 0;  ///< that began after their time
  std::vector<Condition> gate;
};

/// Whether a controller meets a condition. One that never answered meets no condition on times.
bool meets(const ReportCard& card, const ControllerCard& controller, const Condition& condition);
/// Whether all meet all. True without a gate.
bool passes(const ReportCard& card);

/// As text: "observations 5 ms ± 2 ms, 1 % lost; commands 4 ms".
std::string to_text(const network::Injection& injection);

/// Several lines without line feed at the end.
std::string to_text(const ReportCard& card);
std::string to_json(const ReportCard& card);
/// The histograms as a picture.
std::string to_svg(const ReportCard& card);

}  // namespace ziggurat::reports
