// SPDX-License-Identifier: MIT
#pragma once
// The programs that run per vertex and per pixel, in GLSL.

namespace ziggurat::render::shaders {

/// Common part of all shaders: the uniforms, and the light. Goes before each of the others.
extern const char* const common;

extern const char* const body_vertex;
extern const char* const body_fragment;
extern const char* const shadow_vertex;
extern const char* const shadow_fragment;
extern const char* const floor_vertex;
extern const char* const floor_fragment;
extern const char* const sky_vertex;
extern const char* const sky_fragment;
extern const char* const mark_vertex;
extern const char* const mark_fragment;
extern const char* const line_vertex;
extern const char* const line_fragment;

}  // namespace ziggurat::render::shaders
