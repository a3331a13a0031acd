#include "recording/readings.h"

#include <utility>

#include "recording/json.h"
#include "recording/reading.h"

namespace ziggurat::recording {

Readings::Readings(std::string path, const world::Layout& layout)
    : layout_(layout), file_(std::move(path)) {}

void Readings::write(const world::State& state, const world::Observations& observations,
                     const world::Commands& commands, const std::vector<world::Metric>& metrics) {
  for (std::size_t robot = 0; robot < layout_.robots.size(); ++robot) {
    if (state.is_absent(layout_.robots[robot].entity)) continue;
    v1::Reading reading = make_reading({layout_, state, observations, commands}, robot);
    for (const world::Metric& metric : metrics) {
      if (metric.robot == reading.robot()) (*reading.mutable_metrics())[metric.name] = metric.value;
    }
    file_.buffer().append(to_json(reading));
    file_.buffer().push_back('\n');
    file_.written();
  }
}

}  // namespace ziggurat::recording
