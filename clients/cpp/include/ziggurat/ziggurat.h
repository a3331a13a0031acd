#pragma once
// The Ziggurat controller library: everything a controller needs. See docs/cpp-client.md.

#include "ziggurat/error.h"
#include "ziggurat/joint.h"
#include "ziggurat/robot.h"
#include "ziggurat/session.h"
