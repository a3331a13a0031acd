// SPDX-License-Identifier: MIT
#include "outputs/trace.h"

#include <fmt/format.h>

#include <iterator>
#include <string_view>
#include <utility>

#include "text/quoting.h"

namespace ziggurat::outputs {

/// Names the rows of new entities and links, or of all when a world begins or goes back.
void Trace::name_rows(const world::State& state) {
  if (state.tick == 0 || state.tick < last_tick_) name_anew();
  last_tick_ = state.tick;
  for (; entities_ < layout_.entities.size(); ++entities_) {
    const auto& entity = layout_.entities[entities_];
    rows_.push_back({fmt::format(",{},,", text::csv_field(entity.id)), entities_, {}});
    if (!entity.lists_links) continue;
    for (std::size_t l = entity.links.begin; l < entity.links.end(); ++l) {
      rows_.push_back(
          {fmt::format(",{},{},", text::csv_field(entity.id), text::csv_field(layout_.links[l].id)),
           entities_, l});
    }
  }
}

Trace::Trace(std::string path, const world::Layout& layout)
    : layout_(layout), file_(std::move(path)) {
  file_.buffer().append(std::string_view("tick,time_s,entity,link,x,y,z,qw,qx,qy,qz\n"));
}

void Trace::name_anew() {
  rows_.clear();
  entities_ = 0;
}

void Trace::write(const world::State& state) {
  name_rows(state);
  const std::string when =
      fmt::format("{},{}", state.tick, static_cast<double>(state.time_ns) / 1e9);
  auto& buffer = file_.buffer();
  for (const Row& row : rows_) {
    if (state.is_absent(row.entity)) continue;
    const math::Pose& pose = row.link ? state.links[*row.link].pose : state.origins[row.entity];
    const auto& p = pose.position;
    const auto& q = pose.orientation;
    buffer.append(when);
    buffer.append(row.names);
    // Without a precision fmt writes the shortest digits that read back to the same double.
    fmt::format_to(std::back_inserter(buffer), FMT_STRING("{},{},{},{},{},{},{}\n"), p.x(), p.y(),
                   p.z(), q.w(), q.x(), q.y(), q.z());
    file_.written();
  }
}

}  // namespace ziggurat::outputs
