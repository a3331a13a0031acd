#include "recording/readings.h"

#include <utility>

#include "recording/json.h"
#include "recording/reading.h"

namespace ziggurat::recording {

Readings::Readings(std::string path, const world::Layout& layout)
    : layout_(layout), file_(std::move(path)) {}

void Readings::write(const world::State& state, const world::Observations& observations,
                     const world::Commands& commands, const std::vector<world::Metric>& metrics) {
  const auto write = [&](v1::Reading reading) {
    for (const world::Metric& metric : metrics) {
      if (metric.robot == reading.robot()) (*reading.mutable_metrics())[metric.name] = metric.value;
    }
    file_.buffer().append(to_json(reading));
    file_.buffer().push_back('\n');
    file_.written();
  };
  if (!metrics.empty() && metrics.front().robot.empty()) {
    v1::Reading of_director;
    of_director.set_tick(observations.tick);
    of_director.set_time_s(static_cast<double>(observations.time_ns) / 1e9);
    write(std::move(of_director));
  }
  for (std::size_t robot = 0; robot < layout_.robots.size(); ++robot) {
    if (state.is_absent(layout_.robots[robot].entity)) continue;
    write(make_reading({layout_, state, observations, commands}, robot));
  }
}

}  // namespace ziggurat::recording
