// SPDX-License-Identifier: MIT
#pragma once
// The C++ client library: all headers that a controller or a director needs. See
// docs/cpp-client.md.

#include "ziggurat/actuators.h"
#include "ziggurat/camera.h"
#include "ziggurat/device.h"
#include "ziggurat/director.h"
#include "ziggurat/entity.h"
#include "ziggurat/error.h"
#include "ziggurat/joint.h"
#include "ziggurat/radio.h"
#include "ziggurat/range_and_bearing.h"
#include "ziggurat/robot.h"
#include "ziggurat/sensors.h"
#include "ziggurat/session.h"
#include "ziggurat/turret.h"
#include "ziggurat/wheels.h"
