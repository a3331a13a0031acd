// SPDX-License-Identifier: MIT
#pragma once
// Names in a picture: white letters with a dark edge, in front of everything.

#include <span>
#include <string>

#include "render/view.h"

namespace ziggurat::render {

struct Label {
  std::string text;     ///< UTF-8
  double u = 0, v = 0;  ///< the middle of its lower edge [px]
  double depth = 0;     ///< along the view [m]: nearer ones cover farther ones
};

/// @param labels  are sorted by depth
void draw_labels(std::span<Label> labels, Picture& picture);

}  // namespace ziggurat::render
