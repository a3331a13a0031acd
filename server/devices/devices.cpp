#include "devices/devices.h"

namespace ziggurat::devices {

Devices::Devices(const Setting& setting, physics::World& physics)
    : joints_(setting, physics),
      wheels_(setting),
      turrets_(setting),
      radios_(setting),
      proximity_(setting),
      range_and_bearing_(setting),
      positioning_(setting),
      batteries_(setting),
      cameras_(setting),
      pictures_(setting) {}

void Devices::add(const Setting& setting, physics::World& physics) {
  joints_.add(setting, physics);
  wheels_.add(setting);
  turrets_.add(setting);
  radios_.add(setting);
  proximity_.add(setting);
  range_and_bearing_.add(setting);
  positioning_.add(setting);
  batteries_.add(setting);
  cameras_.add(setting);
  pictures_.add(setting);
}

void Devices::start(Tick& tick) {
  joints_.start(tick);
  wheels_.start(tick);
  turrets_.start(tick);
  start_visible(tick);
  proximity_.start(tick);
  positioning_.start(tick);
  batteries_.start(tick);
  pictures_.start(tick);
}

void Devices::apply(Tick& tick) {
  joints_.apply(tick);
  wheels_.apply(tick);
  turrets_.apply(tick);
  apply_visible(tick);
  radios_.apply(tick);
}

void Devices::sense(Tick& tick) {
  joints_.sense(tick);
  wheels_.sense(tick);
  turrets_.sense(tick);
  proximity_.sense(tick);
  range_and_bearing_.sense(tick);
  positioning_.sense(tick);
  batteries_.sense(tick);
  cameras_.sense(tick);
  pictures_.sense(tick);
}

}  // namespace ziggurat::devices
