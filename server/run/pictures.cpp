#include "run/pictures.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <string_view>
#include <utility>

#include "recording/png.h"
#include "run/loading.h"

namespace ziggurat::run {
namespace {

/// The place of `%d` or `%0Nd` in a path, or nothing.
struct Placeholder {
  std::size_t begin, size;
  std::size_t digits;
};

std::optional<Placeholder> find_placeholder(std::string_view text) {
  for (std::size_t begin = text.find('%'); begin != std::string_view::npos;
       begin = text.find('%', begin + 1)) {
    std::size_t end = begin + 1;
    std::size_t digits = 0;
    while (end < text.size() && text[end] >= '0' && text[end] <= '9' && digits < 100) {
      digits = 10 * digits + static_cast<std::size_t>(text[end++] - '0');
    }
    if (end < text.size() && text[end] == 'd' && digits < 20) {
      return Placeholder{begin, end + 1 - begin, digits};
    }
  }
  return std::nullopt;
}

}  // namespace

std::uint64_t last_tick(const PictureOptions& options, const scene::Experiment& experiment) {
  return tick_at(*std::ranges::max_element(options.times), experiment);
}

std::string picture_path(const std::string& out, std::size_t number, std::size_t of) {
  const auto placeholder = find_placeholder(out);
  if (placeholder) {
    return out.substr(0, placeholder->begin) +
           fmt::format("{:0{}}", number, std::max<std::size_t>(placeholder->digits, 1)) +
           out.substr(placeholder->begin + placeholder->size);
  }
  if (of == 1) return out;
  const std::filesystem::path path(out);
  return (path.parent_path() /
          fmt::format("{}_{:03}{}", path.stem().string(), number, path.extension().string()))
      .string();
}

Pictures::Pictures(const PictureOptions& options, const scene::Scene& scene,
                   std::vector<scene::Entity> entities, const world::Layout& layout)
    : options_(options),
      scene_(scene),
      entities_(std::move(entities)),
      renderer_(scene, entities_, layout) {
  renderer_.prepare();
}

void Pictures::tick(const world::State& state) {
  const auto& times = options_.times;
  for (std::size_t i = 0; i < times.size(); ++i) {
    if (tick_at(times[i], scene_.experiment) != state.tick) continue;
    if (!view_) view_ = choose_view(options_.view, extent_of(scene_, entities_, state));
    renderer_.draw(state, *view_, picture_);
    taken_.push_back(picture_path(options_.out, i, times.size()));
    recording::write_png(taken_.back(), picture_.width, picture_.height, picture_.rgb);
  }
}

}  // namespace ziggurat::run
