// SPDX-License-Identifier: MIT
#include "recording/recorder/start.h"

#include "ziggurat/v1/envelope.h"

namespace ziggurat::recorder {

v1::RunStart to_message(const Start& from) {
  v1::RunStart to;
  to.set_scene(v1::valid_utf8(from.scene));
  to.set_scene_hash(from.scene_hash);
  to.set_seed(from.seed);
  to.set_lenient(from.lenient);
  const auto add = [](const auto& values, auto& target) {
    for (const auto& [name, value] : values) {
      v1::RunStart::Value& each = *target.Add();
      each.set_name(v1::valid_utf8(name));
      each.set_value(v1::valid_utf8(value));
    }
  };
  add(from.settings, *to.mutable_settings());
  add(from.parameters, *to.mutable_parameters());
  to.set_clock(from.clock);
  to.set_core(1);
  to.set_last_tick(from.last_tick);
  for (const Start::Controller& each : from.controllers) {
    v1::RunStart::Controller& controller = *to.add_controllers();
    controller.set_id(v1::valid_utf8(each.id));
    controller.set_command(v1::valid_utf8(each.command));
    controller.set_script(v1::valid_utf8(each.script));
  }
  for (const std::size_t robot : from.robots_without_controller) {
    to.add_robots_without_controller(static_cast<std::uint32_t>(robot));
  }
  to.set_date(from.date);
  v1::RunStart::Build& build = *to.mutable_build();
  build.set_version(from.build.version);
  build.set_compiler(from.build.compiler);
  build.set_options(v1::valid_utf8(from.build.options));
  build.set_libm(from.build.libm);
  build.set_cpu_path(from.build.cpu_path);
  for (const std::string& argument : from.arguments) to.add_arguments(v1::valid_utf8(argument));
  to.set_snapshot(from.snapshot);
  return to;
}

}  // namespace ziggurat::recorder
