// SPDX-License-Identifier: MIT
#include "outputs/readings.h"

#include <map>
#include <string_view>
#include <utility>

#include "outputs/json.h"
#include "outputs/reading.h"

namespace ziggurat::outputs {

Readings::Readings(std::string path, const world::Layout& layout)
    : layout_(layout), file_(std::move(path)) {}

void Readings::write(const world::State& state, const world::Observations& observations,
                     const world::Commands& commands, const std::vector<world::Metric>& metrics) {
  std::map<std::string_view, std::map<std::string_view, double>> measured;  // by id
  for (const world::Metric& metric : metrics) measured[metric.robot][metric.name] = metric.value;
  const auto write_line = [&](v1::Reading& reading) {
    const auto found = measured.find(reading.robot());
    if (found != measured.end()) {
      for (const auto& [name, value] : found->second) {
        (*reading.mutable_metrics())[std::string(name)] = value;
      }
    }
    write_json(reading, file_);
    file_.buffer().push_back('\n');
    file_.written();
  };
  for (std::size_t robot = 0; robot < layout_.robots.size(); ++robot) {
    const std::string& id = layout_.robots[robot].id;
    if (!state.is_absent(layout_.robots[robot].entity)) {
      v1::Reading reading = make_reading({layout_, state, observations, commands}, robot);
      write_line(reading);
    }
    measured.erase(id);
  }
  for (const auto& each : measured) {  // of directors
    v1::Reading reading;
    reading.set_tick(observations.tick);
    reading.set_time_s(static_cast<double>(observations.time_ns) / 1e9);
    reading.set_robot(std::string(each.first));
    write_line(reading);
  }
}

}  // namespace ziggurat::outputs
