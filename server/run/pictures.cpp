// SPDX-License-Identifier: MIT
#include "run/pictures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string_view>
#include <thread>
#include <utility>

#include "outputs/images.h"
#include "run/loading.h"
#include "text/names.h"
#include "text/numbers.h"

namespace ziggurat::run {
namespace {

/// The place of `%d` or `%0Nd` in a path, or nothing.
struct NumberPlace {
  std::size_t begin, size;
  std::size_t digits;
};

std::optional<NumberPlace> find_number_place(std::string_view text) {
  for (std::size_t begin = text.find('%'); begin != std::string_view::npos;
       begin = text.find('%', begin + 1)) {
    std::size_t end = begin + 1;
    std::size_t digits = 0;
    while (end < text.size() && text[end] >= '0' && text[end] <= '9' && digits < 100) {
      digits = 10 * digits + static_cast<std::size_t>(text[end++] - '0');
    }
    if (end < text.size() && text[end] == 'd' && digits < 20) {
      return NumberPlace{begin, end + 1 - begin, digits};
    }
  }
  return std::nullopt;
}

}  // namespace

namespace {

double end_of(const FilmOptions& film, const scene::Experiment& experiment) {
  if (film.to) return *film.to;
  if (experiment.length <= film.from) {
    throw text::UsageError("--video needs an end, which the scene has not; write --to SECONDS");
  }
  return experiment.length;
}

/// At least one.
std::uint64_t frame_count(const FilmOptions& film, const scene::Experiment& experiment) {
  constexpr double most = 1e15;  // a recording may claim any end
  const double length = (end_of(film, experiment) - film.from) / film.speed;
  return static_cast<std::uint64_t>(
      std::clamp(std::round(length * film.frames_per_second), 1.0, most));
}

/// A film has less to show of each frame than a picture: outlines with four samples are enough.
render::View view_of_film(render::View view) {
  view.oversampling = 1;
  return view;
}

std::uint64_t tick_of_frame(std::uint64_t frame, const FilmOptions& film,
                            const scene::Experiment& experiment) {
  return tick_at(film.from + static_cast<double>(frame) * film.speed / film.frames_per_second,
                 experiment);
}

/// No more than there are pictures.
unsigned threads_for(std::uint64_t pictures) {
  constexpr unsigned most = 4;
  const unsigned cores = std::max(1u, std::thread::hardware_concurrency());
  return static_cast<unsigned>(std::min<std::uint64_t>(std::min(most, cores), pictures));
}

std::uint64_t picture_count(const PictureOptions& options, const scene::Experiment& experiment) {
  return (options.out.empty() ? 0 : options.times.size()) +
         (options.film ? frame_count(*options.film, experiment) : 0);
}

/// Whether both have the same name, and their parts the same places.
bool is_same(const world::EntityLayout& a, const world::EntityLayout& b) {
  const auto equal = [&](world::Range world::EntityLayout::*range) {
    return (a.*range).begin == (b.*range).begin && (a.*range).count == (b.*range).count;
  };
  return a.id == b.id && equal(&world::EntityLayout::links) && equal(&world::EntityLayout::leds) &&
         equal(&world::EntityLayout::directional_leds) && equal(&world::EntityLayout::tags);
}

std::optional<std::size_t> find_entity(const std::string& id, const world::Layout& layout) {
  if (id.empty()) return std::nullopt;
  std::vector<std::string> ids;
  for (const world::EntityLayout& entity : layout.entities) ids.push_back(entity.id);
  const auto found = std::ranges::find(ids, id);
  if (found != ids.end()) return static_cast<std::size_t>(found - ids.begin());
  throw text::UsageError(fmt::format(
      "--follow: the scene has no entity '{}'; {}", id,
      text::advice(id, ids,
                   ids.empty() ? "it has none" : "write the id of one, such as '" + ids[0] + "'")));
}

}  // namespace

std::uint64_t last_tick(const PictureOptions& options, const scene::Experiment& experiment) {
  std::uint64_t last = 0;
  if (!options.out.empty()) {
    last = tick_at(*std::ranges::max_element(options.times), experiment);
  }
  if (options.film) {
    const std::uint64_t frames = frame_count(*options.film, experiment);
    last = std::max(last, tick_of_frame(frames - 1, *options.film, experiment));
  }
  return last;
}

void check_picture_path(const std::string& out) {
  constexpr std::string_view between = "-+#0123456789", conversions = "diouxXeEfFgGaAcspn";
  const auto number = find_number_place(out);
  for (std::size_t begin = out.find('%'); begin != std::string::npos;
       begin = out.find('%', begin + 1)) {
    const std::size_t end = out.find_first_not_of(between, begin + 1);
    const bool is_other =
        end != std::string::npos && conversions.find(out[end]) != conversions.npos;
    if (!is_other || (number && begin == number->begin)) continue;
    throw text::UsageError(
        fmt::format("--out is '{}': '{}' {}; write %03d once, for the number of the picture", out,
                    out.substr(begin, end + 1 - begin),
                    number && begin > number->begin ? "stands behind another place for a number"
                                                    : "is no place for a number"));
  }
}

std::string picture_path(const std::string& out, std::size_t number, std::size_t of) {
  const auto place = find_number_place(out);
  if (place) {
    return out.substr(0, place->begin) +
           fmt::format("{:0{}}", number, std::max<std::size_t>(place->digits, 1)) +
           out.substr(place->begin + place->size);
  }
  if (of == 1) return out;
  const std::filesystem::path path(out);
  return (path.parent_path() /
          fmt::format("{}_{:03}{}", path.stem().string(), number, path.extension().string()))
      .string();
}

Pictures::Pictures(const PictureOptions& options, const scene::Scene& scene,
                   const simulation::Simulation& simulation)
    : options_(options),
      scene_(scene),
      followed_(find_entity(options.view.follow, simulation.layout())) {
  populate(simulation);
  if (followed_) followed_link_ = simulation.layout().entities[*followed_].links.begin;
  if (!options.film) return;
  frames_ = frame_count(*options.film, scene.experiment);
  film_.emplace(options.film->path, outputs::FilmFormat{options.view.width, options.view.height,
                                                        options.film->frames_per_second});
}

/// Before entities that came, or other ones after a reset, are drawn.
void Pictures::populate(const simulation::Simulation& simulation) {
  if (several_) several_->finish();
  entities_ = simulation.entities();
  places_ = simulation.layout().entities;
  several_.emplace(scene_, entities_, simulation.layout(),
                   threads_for(picture_count(options_, scene_.experiment)));
}

void Pictures::draw(const simulation::Simulation& simulation, const render::View& view,
                    render::Several::Take take) {
  if (!std::ranges::equal(places_, simulation.layout().entities, is_same)) populate(simulation);
  several_->draw(simulation.state(), simulation.rays(), view, std::move(take));
}

/// View of the first picture, moved with the entity that it follows.
render::View Pictures::view(const world::State& state) {
  const auto place = [&] { return state.origins[*followed_].position; };
  if (!view_) {
    view_ = choose_view(options_.view,
                        followed_ ? extent_about(entities_[*followed_], followed_link_, state)
                                  : extent_of(scene_, entities_, state));
    if (followed_) seen_at_ = place();
  }
  render::View view = *view_;
  if (followed_) view.camera.position += place() - seen_at_;
  return view;
}

void Pictures::tick(const simulation::Simulation& simulation) {
  const world::State& state = simulation.state();
  const auto& times = options_.times;
  // After a reset or restore one with the same name and places may be another.
  if (state.tick != next_tick_) places_.clear();
  next_tick_ = state.tick + 1;
  for (std::size_t i = 0; i < times.size() && !options_.out.empty(); ++i) {
    if (tick_at(times[i], scene_.experiment) != state.tick) continue;
    const std::string path = picture_path(options_.out, i, times.size());
    if (std::ranges::find(taken_, path) == taken_.end()) {  // otherwise after a reset, again
      taken_.push_back(path);
      ++pictures_;
    }
    draw(simulation, view(state), [path](const render::Picture& picture) {
      outputs::write_png(path, picture.width, picture.height, picture.rgb);
    });
  }
  std::uint64_t copies = 0;  // with more frames than ticks
  while (next_frame_ < frames_ &&
         tick_of_frame(next_frame_, *options_.film, scene_.experiment) == state.tick) {
    ++next_frame_;
    ++copies;
  }
  if (copies == 0) return;
  draw(simulation, view_of_film(view(state)), [this, copies](const render::Picture& picture) {
    for (std::uint64_t i = 0; i < copies; ++i) film_->write(picture.rgb);
  });
}

void Pictures::close() {
  several_->finish();
  if (!film_) return;
  film_->close();
  const bool is_new = std::ranges::find(taken_, film_->path()) == taken_.end();
  if (is_new && film_->frames() > 0) taken_.push_back(film_->path());
}

std::string Pictures::shortcoming() const {
  if (const std::size_t missing = (options_.out.empty() ? 0 : options_.times.size()) - pictures_;
      missing > 0) {
    return fmt::format(
        "{}: {} of {} pictures were not taken, because the run ended before their times",
        options_.out, missing, options_.times.size());
  }
  if (!film_ || film_->frames() == frames_) return {};
  if (film_->frames() == 0) {
    return fmt::format("{}: there is no film, because the run ended before its first frame",
                       film_->path());
  }
  return fmt::format("{}: the film has the first {} of {} frames, because the run ended early",
                     film_->path(), film_->frames(), frames_);
}

}  // namespace ziggurat::run
