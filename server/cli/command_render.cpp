// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <map>
#include <numbers>
#include <optional>
#include <string_view>

#include "cli/arguments.h"
#include "cli/commands.h"
#include "cli/options.h"
#include "run/run.h"
#include "text/numbers.h"

namespace ziggurat::cli {
namespace {

namespace po = boost::program_options;

constexpr unsigned largest_side = 16384;  // [px]

math::Vector3 to_point(std::string_view option, const std::string& text) {
  math::Vector3 point;
  text::to_numbers(option, text, "x,y,z in metres, as 1,-1,0.5", {point.data(), 3});
  return point;
}

unsigned to_side(const std::string& text) {
  const auto side = text::to_integer("--size", text);
  if (side < 1 || side > largest_side) {
    throw text::UsageError(
        fmt::format("--size: {} is not from 1 to {} pixels", text, largest_side));
  }
  return static_cast<unsigned>(side);
}

void read_size(const std::string& text, run::PictureOptions& pictures) {
  const auto sides = text::split(text, 'x');
  if (sides.size() != 2) {
    throw text::UsageError(
        fmt::format("--size is '{}'; it must be WIDTHxHEIGHT in pixels, as 1280x720", text));
  }
  pictures.view.width = to_side(sides[0]);
  pictures.view.height = to_side(sides[1]);
}

std::vector<double> to_times(const std::string& text) {
  std::vector<double> times;
  for (const auto& part : text::split(text, ',')) {
    times.push_back(text::to_number("--at", part));
    if (times.back() < 0)
      throw text::UsageError("--at is negative; write simulated seconds from 0 on");
    run::check_time("--at", times.back());
  }
  return times;
}

render::Layers to_layers(const std::string& text) {
  const std::map<std::string, bool render::Layers::*> known{{"rays", &render::Layers::rays},
                                                            {"frusta", &render::Layers::frusta},
                                                            {"labels", &render::Layers::labels}};
  render::Layers layers;
  for (const std::string& part : text::split(text, ',')) {
    const auto found = known.find(part);
    if (found == known.end()) {
      throw text::UsageError(fmt::format(
          "--layers: there is no layer '{}'; the layers are rays, frusta and labels, as "
          "--layers rays,labels",
          part));
    }
    layers.*found->second = true;
  }
  return layers;
}

std::optional<run::FilmOptions> film_options(const po::variables_map& values) {
  const auto number = [&](const char* name) {
    return text::to_number(std::string("--") + name, values[name].as<std::string>());
  };
  if (!values.count("video")) {
    for (const char* name : {"fps", "speed", "from", "to"}) {
      if (values.count(name)) {
        throw text::UsageError(fmt::format("--{} is for films; write --video FILE.mp4 too", name));
      }
    }
    return std::nullopt;
  }
  run::FilmOptions film;
  film.path = values["video"].as<std::string>();
  if (!outputs::is_film(film.path)) {
    throw text::UsageError(fmt::format("--video is '{}'; its name must end with {}", film.path,
                                       outputs::film_endings));
  }
  if (values.count("fps")) film.frames_per_second = number("fps");
  if (!(film.frames_per_second >= 0.1 && film.frames_per_second <= 1000)) {
    throw text::UsageError("--fps must be 0.1 to 1000 frames per second");
  }
  if (values.count("speed")) film.speed = number("speed");
  if (!(film.speed >= 0.001 && film.speed <= 1000)) {
    throw text::UsageError(
        "--speed must be 0.001 to 1000; 2 is twice as fast as in the simulation");
  }
  if (values.count("from")) film.from = number("from");
  if (values.count("to")) film.to = number("to");
  if (film.from < 0 || (film.to && *film.to <= film.from)) {
    throw text::UsageError(
        "--from and --to are simulated seconds; write --from from 0 on, and --to after it");
  }
  run::check_time("--from", film.from);
  run::check_time("--to", film.to.value_or(0));
  return film;
}

}  // namespace

std::optional<run::PictureOptions> to_pictures(const po::variables_map& values) {
  run::PictureOptions pictures;
  const auto text = [&](const char* name) { return values[name].as<std::string>(); };
  pictures.film = film_options(values);
  if (values.count("out")) pictures.out = text("out");
  run::check_picture_path(pictures.out);
  if (pictures.out.empty() && !pictures.film) {
    for (const char* name : {"at", "follow", "layers", "eye", "look-at", "size", "fov"}) {
      if (!values.count(name)) continue;
      throw text::UsageError(
          fmt::format("--{} is for pictures; write --out FILE.png or --video FILE.mp4 too", name));
    }
    return std::nullopt;
  }
  check_needs(Values(values), {"at"}, "out");
  if (values.count("at")) pictures.times = to_times(text("at"));
  if (values.count("follow")) pictures.view.follow = text("follow");
  if (values.count("follow") && values.count("look-at")) {
    throw text::UsageError(
        "--follow and --look-at both say what is in the middle; write one of them");
  }
  if (values.count("layers")) pictures.view.layers = to_layers(text("layers"));
  if (values.count("eye")) pictures.view.eye = to_point("--eye", text("eye"));
  if (values.count("look-at")) pictures.view.look_at = to_point("--look-at", text("look-at"));
  if (pictures.view.eye && pictures.view.eye == pictures.view.look_at) {
    throw text::UsageError(
        "--eye and --look-at are the same point, which gives no direction; write two different "
        "points");
  }
  if (values.count("size")) read_size(text("size"), pictures);
  if (values.count("fov")) {
    const double degrees = text::to_number("--fov", text("fov"));
    if (!(degrees >= 0.1 && degrees <= 170)) {
      throw text::UsageError(
          fmt::format("--fov is {}; it must be 0.1 to 170 degrees", text("fov")));
    }
    pictures.view.opening = degrees * std::numbers::pi / 180;
  }
  return pictures;
}

std::string help_render() {
  return R"(usage: ziggurat render SCENE --out FILE.png [OPTION]...
       ziggurat render SCENE --video FILE.mp4 [OPTION]...

Draws a scene, off-screen and on the CPU: no display is needed. For a picture of a later time, and for a
film, the scene runs with its controllers, exactly as with `ziggurat run`.

  ziggurat render vehicle.argos --out start.png
      the whole arena at the start
  ziggurat render vehicle.argos --at 5 --eye 1,-1,0.5 --look-at 0,0,0.1 --out later.png
      after five simulated seconds, from a given viewpoint
  ziggurat render vehicle.argos --at 0,1,2,3 --out 'frame_%03d.png'
      several pictures of one run: frame_000.png to frame_003.png
  ziggurat render drop.argos --at 2 --without-controllers --out drop.png
      physics alone
  ziggurat render vehicle.argos --video drive.mp4 --to 10
      a film of ten simulated seconds; .webm, .webp and .gif are animated, too
  ziggurat render vehicle.argos --video close.mp4 --follow vehicle1 --layers rays,labels --from 5 --to 10
      the view stays with a robot; with the rays of its sensors and the names of all entities

Films are made by ffmpeg (sudo apt install ffmpeg). Ctrl-C ends a film early: it can be played as far as
it got. Pictures are drawn on all cores; they are the same, bit by bit, whatever the number of cores.
Layers: rays of all sensors, links of radios included; frusta, what cameras can see; labels, the ids of
entities.

The world's z axis points up in the picture. Links are coloured by their kind: fixed links are grey,
movable boxes brown, movable cylinders teal, spheres light grey, robots blue. Tags whose payload is an integer 0 to 586 have
that pattern of AprilTag 36h11, others are white. LEDs are discs in their colour, dark ones are off; they
are drawn at least three pixels wide. Squares on the floor have a side of 1, 2 or 5 times a power of
ten in metres, ten or more to the arena's shorter side.

stdout has the lines that controllers log, and the names of the pictures. Exit codes are those of `run`.
)";
}

int execute_render(const Arguments& arguments, processes::Signals& signals) {
  run::Options options = parse_options(arguments, run::by_render);
  run::only_scene(options);
  options.pictures = to_pictures(parse(arguments, options_of(run::by_render)).values);
  if (!options.pictures) {
    throw text::UsageError("no output file is given; write --out FILE.png or --video FILE.mp4");
  }
  run::SceneStart start(options);
  return run::Run(options, start, run::Service::run, signals).execute();
}

}  // namespace ziggurat::cli
