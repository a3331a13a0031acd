// SPDX-License-Identifier: MIT
#include "mujoco_models.h"

#include <cmath>
#include <cstdio>
#include <cstring>
#include <memory>
#include <stdexcept>

namespace ziggurat::yardstick {

std::string text(std::string pattern, std::initializer_list<double> numbers) {
  int index = 0;
  for (const double number : numbers) {
    const std::string mark = "{" + std::to_string(++index) + "}";
    char digits[32];
    std::snprintf(digits, sizeof digits, "%.12g", number);
    for (std::size_t at = 0; (at = pattern.find(mark)) != std::string::npos;) {
      pattern.replace(at, mark.size(), digits);
    }
  }
  return pattern;
}

Model::Model(const std::string& bodies, double length, const math::Vector3& gravity,
             const char* integrator, const std::string& motors) {
  const std::string head =
      text(
          "<mujoco><size njmax='2000' nconmax='600'/><option timestep='{1}' gravity='{2} {3} {4}' ",
          {length, gravity.x(), gravity.y(), gravity.z()}) +
      "cone='elliptic' solver='Newton' integrator='" + integrator +
      "'><flag energy='enable'/></option>";
  const std::string xml = head + "<worldbody>" + bodies + "</worldbody>" +
                          (motors.empty() ? "" : "<actuator>" + motors + "</actuator>") +
                          "</mujoco>";
  const auto files = std::make_unique<mjVFS>();
  mj_defaultVFS(files.get());
  mj_makeEmptyFileVFS(files.get(), "model.xml", static_cast<int>(xml.size()));
  std::memcpy(files->filedata[0], xml.data(), xml.size());
  char error[1000] = "";
  model = mj_loadXML("model.xml", files.get(), error, sizeof error);
  mj_deleteFileVFS(files.get(), "model.xml");
  if (!model) throw std::runtime_error(error);
  data = mj_makeData(model);
}

Model::~Model() {
  mj_deleteData(data);
  mj_deleteModel(model);
}

void Model::without_contacts() { model->opt.disableflags |= mjDSBL_CONTACT; }

void Model::stiffen() {
  mjOption& option = model->opt;
  option.enableflags |= mjENBL_OVERRIDE;
  option.o_margin = 0;
  option.o_solref[0] = 2 * option.timestep, option.o_solref[1] = 1;
  const mjtNum impedance[] = {0.99, 0.999, 1e-4, 0.5, 2};
  for (int i = 0; i < 5; ++i) option.o_solimp[i] = impedance[i];
}

void Model::run(double seconds) {
  const int steps = static_cast<int>(std::lround(seconds / model->opt.timestep));
  for (int i = 0; i < steps; ++i) step();
}

double Model::energy() {
  mj_forward(model, data);
  return data->energy[0] + data->energy[1];
}

math::Vector3 Model::place(int body) const {
  mj_kinematics(model, data);
  const mjtNum* at = data->xpos + 3 * body;
  return {at[0], at[1], at[2]};
}

std::string robot(const math::Vector3& at, int number) {
  return text(
      "<body pos='{1} {2} 0.012'><freejoint/>"
      "<geom type='cylinder' pos='0 0 0.015' size='0.05 0.015' mass='0.3' friction='0.7 0 0'/>"
      "<geom type='sphere' pos='0.035 0 -0.006' size='0.005' mass='0.01' friction='0.7 0 0'/>"
      "<geom type='sphere' pos='-0.035 0 -0.006' size='0.005' mass='0.01' friction='0.7 0 0'/>"
      "<body pos='0 0.058 0.008' euler='-90 0 0'><joint name='{3}l' axis='0 0 1'/>"
      "<geom type='cylinder' size='0.02 0.003' mass='0.02' friction='0.7 0 0'/></body>"
      "<body pos='0 -0.058 0.008' euler='-90 0 0'><joint name='{3}r' axis='0 0 1'/>"
      "<geom type='cylinder' size='0.02 0.003' mass='0.02' friction='0.7 0 0'/></body></body>",
      {at.x(), at.y(), double(number)});
}

}  // namespace ziggurat::yardstick
