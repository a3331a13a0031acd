// SPDX-License-Identifier: MIT
#include "render/shaders.h"

namespace ziggurat::render::shaders {

// Everything is in the camera's frame: z forward, x right, y down. Depth is near / z, with 1 at the
// near plane and 0 at infinity: in floating point it is equally fine, relatively, at all distances.
const char* const common = R"(#version 450 core
layout(std140, binding = 0) uniform Frame {
  mat4 clip_from_camera;
  mat4 light_from_camera;
  vec4 sun;    // towards it; w: side of a texel of the shadow map [m], 0: no shadows
  vec4 right;  // world's x, y and z; w: the eye's coordinate along them, less the origin of tiles
  vec4 ahead;
  vec4 up;
  vec4 ground;  // side of a tile [m], width of a line in clip coordinates, near plane [m], its height
  vec4 arena;   // centre less the origin of tiles, half size [m]
  vec4 painting;  // x: 1 if the floor has colours of its own
};
layout(binding = 0) uniform sampler2DShadow shadow_map;

const vec3 horizon = vec3(0.74, 0.79, 0.84);
const vec3 zenith = vec3(0.30, 0.45, 0.66);

// The mean of 3 x 3 lookups, each between four texels: 4 x 4 texels with weights. Loops are left when
// no pixel is in them any more, which `if` is not on the CPU: so what is in the dark, or beyond the
// map, costs no lookups.
float sunlight(vec3 position, vec3 normal) {
  float facing = max(dot(normal, sun.xyz), 0.0);
  float lit = facing;
  vec4 place = light_from_camera * vec4(position + normal * (1.5 * sun.w), 1.0);
  const float size = textureSize(shadow_map, 0).x;
  float margin = 3.0 / size;
  bool is_on_map = sun.w > 0.0 && facing > 0.0 && all(greaterThan(place.xy, vec2(-margin))) &&
                   all(lessThan(place.xy, vec2(1.0 + margin)));
  while (is_on_map) {
    vec2 texels = place.xy * size - 0.5;
    vec2 corner = floor(texels), part = texels - corner;
    float depth = min(place.z, 1.0);
    vec4 low_left = textureGather(shadow_map, corner / size, depth);
    vec4 low_right = textureGather(shadow_map, (corner + vec2(2.0, 0.0)) / size, depth);
    vec4 high_left = textureGather(shadow_map, (corner + vec2(0.0, 2.0)) / size, depth);
    vec4 high_right = textureGather(shadow_map, (corner + 2.0) / size, depth);
    vec2 before = 1.0 - part;
    // Order of a gathering: left above, right above, right below, left below.
    float rows[4] = float[4](before.x * low_left.w + low_left.z + low_right.w + part.x * low_right.z,
                             before.x * low_left.x + low_left.y + low_right.x + part.x * low_right.y,
                             before.x * high_left.w + high_left.z + high_right.w + part.x * high_right.z,
                             before.x * high_left.x + high_left.y + high_right.x + part.x * high_right.y);
    lit = facing * (before.y * rows[0] + rows[1] + rows[2] + part.y * rows[3]) / 9.0;
    is_on_map = false;
  }
  return lit;
}

vec3 shaded(vec3 albedo, vec3 position, vec3 normal) {
  vec3 ambient = mix(vec3(0.30, 0.28, 0.26), vec3(0.46, 0.50, 0.56), 0.5 + 0.5 * dot(normal, up.xyz));
  float sunny = sunlight(position, normal);
  vec3 halfway = normalize(sun.xyz - normalize(position));
  float gloss = max(dot(normal, halfway), 0.0);
  gloss *= gloss;
  gloss *= gloss;
  gloss *= gloss;             // the power 8
  float power_16 = gloss * gloss;
  gloss *= 0.10 * power_16 * power_16 * sunny;
  return albedo * (ambient + vec3(0.72, 0.68, 0.62) * sunny) + gloss;
}

// The power 1 / 2.2, to within half a step of 8 bits: square roots are a tenth of the work.
vec4 shown(vec3 light) {
  vec3 half_power = sqrt(clamp(light, 0.0, 1.0)), quarter = sqrt(half_power), eighth = sqrt(quarter);
  return vec4(0.79608 * half_power + 0.28361 * quarter - 0.07969 * eighth, 1.0);
}
)";

const char* const body_vertex = R"(
layout(location = 0) in vec3 vertex;
layout(location = 1) in vec3 vertex_normal;
layout(location = 2) in vec3 vertex_edge;
layout(location = 3) in mat3 axes;
layout(location = 6) in vec3 origin;
layout(location = 7) in vec3 full_size;
layout(location = 8) in vec3 albedo;
out vec3 position;
out vec3 normal;
out vec3 edge;
flat out vec3 size;
flat out vec3 color;

void main() {
  position = axes * vertex + origin;
  normal = mat3(normalize(axes[0]), normalize(axes[1]), normalize(axes[2])) * vertex_normal;
  edge = vertex_edge;
  size = full_size;
  color = albedo;
  gl_Position = clip_from_camera * vec4(position, 1.0);
}
)";

// Edges are drawn a little darker, so that blocks on blocks can be told apart.
const char* const body_fragment = R"(
in vec3 position;
in vec3 normal;
in vec3 edge;
flat in vec3 size;
flat in vec3 color;
layout(location = 0) out vec4 pixel;

void main() {
  vec3 distances = abs(1.0 - abs(edge)) * 0.5 * size;
  float distance_to_edge = min(distances.x, min(distances.y, distances.z));
  float smallest = min(size.x, min(size.y, size.z));
  float footprint = max(fwidth(distance_to_edge), 1e-9);
  float width = max(0.012 * smallest, 0.8 * footprint);
  float line = clamp((width - distance_to_edge) / footprint + 0.5, 0.0, 1.0);
  line *= clamp(smallest / (24.0 * footprint), 0.0, 1.0);
  pixel = shown(shaded(color * (1.0 - 0.45 * line), position, normalize(normal)));
}
)";

const char* const shadow_vertex = R"(
layout(location = 0) in vec3 vertex;
layout(location = 3) in mat3 axes;
layout(location = 6) in vec3 origin;

void main() {
  vec4 place = light_from_camera * vec4(axes * vertex + origin, 1.0);
  gl_Position = vec4(2.0 * place.xy - 1.0, place.z, 1.0);
}
)";

const char* const shadow_fragment = R"(
void main() {}
)";

// The floor is a plane without end. near / z of its points is linear over the picture. So a
// triangle over all of it has the floor's depth, and its clipping cuts off the part above the
// horizon.
const char* const floor_vertex = R"(
out vec2 at;

void main() {
  at = vec2(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0);
  vec3 ray = vec3((at.x - clip_from_camera[2][0]) / clip_from_camera[0][0],
                  (at.y - clip_from_camera[2][1]) / clip_from_camera[1][1], 1.0);
  gl_Position = vec4(at, -ground.z * dot(up.xyz, ray) / up.w, 1.0);
}
)";

const char* const floor_fragment = R"(
layout(binding = 1) uniform sampler2D floor_colors;
in vec2 at;
layout(location = 0) out vec4 pixel;

// Mean of a checkerboard over a pixel's footprint: -1 to 1.
float checks(vec2 place, vec2 footprint) {
  vec2 w = max(footprint, 1e-6);
  vec2 low = abs(fract((place - 0.5 * w) * 0.5) - 0.5);
  vec2 high = abs(fract((place + 0.5 * w) * 0.5) - 0.5);
  vec2 mean = 2.0 * (low - high) / w;
  return mean.x * mean.y;
}

void main() {
  vec3 ray = vec3((at.x - clip_from_camera[2][0]) / clip_from_camera[0][0],
                  (at.y - clip_from_camera[2][1]) / clip_from_camera[1][1], 1.0);
  vec3 position = ray * (-up.w / dot(up.xyz, ray));
  vec2 place = vec2(dot(right.xyz, position) + right.w, dot(ahead.xyz, position) + ahead.w);
  vec2 footprint = fwidth(place);
  float contrast = 0.035 * checks(place / ground.x, footprint / ground.x);
  vec2 beyond = (abs(place - arena.xy) - arena.zw) / max(footprint, 1e-6);
  float inside = clamp(0.5 - max(beyond.x, beyond.y), 0.0, 1.0);
  vec3 albedo = mix(vec3(0.40, 0.41, 0.42), vec3(0.56, 0.57, 0.58), inside) * (1.0 + contrast);
  if (painting.x > 0.0) {  // a little darker than their colours, because light adds to them
    vec4 color = texture(floor_colors, (place - arena.xy) / (2.0 * arena.zw) + 0.5);
    albedo = mix(albedo, 0.9 * pow(color.rgb, vec3(2.2)), color.a * inside);
  }
  vec3 normal = up.w >= 0.0 ? up.xyz : -up.xyz;
  float extent = length(arena.zw) + abs(up.w);
  float beyond_haze = length(position) - 2.0 * extent, haze = 0.0;
  while (beyond_haze > 0.0) {  // see sunlight()
    haze = 1.0 - exp(-beyond_haze / (6.0 * extent));
    beyond_haze = 0.0;
  }
  pixel = shown(mix(shaded(albedo, position, normal), horizon, haze));
}
)";

const char* const sky_vertex = R"(
out vec2 at;

void main() {
  at = vec2(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0);
  gl_Position = vec4(at, 0.0, 1.0);
}
)";

const char* const sky_fragment = R"(
in vec2 at;
layout(location = 0) out vec4 pixel;

void main() {
  vec3 ray = vec3((at.x - clip_from_camera[2][0]) / clip_from_camera[0][0],
                  (at.y - clip_from_camera[2][1]) / clip_from_camera[1][1], 1.0);
  float slope = dot(up.xyz, ray) / length(ray);
  float root = sqrt(min(abs(slope), 1.0));
  pixel = shown(mix(horizon, zenith, root * sqrt(root)));
}
)";

// Tags and LEDs have their own colours, whatever the light: so they are always legible.
const char* const mark_vertex = R"(
layout(location = 0) in vec3 center;
layout(location = 1) in vec3 half_x;
layout(location = 2) in vec3 half_y;
layout(location = 3) in vec3 disc_color;
layout(location = 4) in uvec3 instance_code;
out vec2 at;
flat out vec3 color;
flat out uvec3 code;

void main() {
  at = vec2((gl_VertexID & 1) == 0 ? -1.0 : 1.0, (gl_VertexID & 2) == 0 ? -1.0 : 1.0);
  color = disc_color;
  code = instance_code;
  gl_Position = clip_from_camera * vec4(center + half_x * at.x + half_y * at.y, 1.0);
  gl_Position.z *= 1.0003;  // in front of the surface that it is mounted on
}
)";

const char* const mark_fragment = R"(
in vec2 at;
flat in vec3 color;
flat in uvec3 code;
layout(location = 0) out vec4 pixel;

const uint pattern = 0u, plain = 1u;
const float white = 0.95, black = 0.06;

// 10 x 10 modules; up is +x, right is -y.
float tag(vec2 place) {
  ivec2 module = ivec2(floor(vec2(0.5 - 0.5 * place.y, 0.5 - 0.5 * place.x) * 10.0));
  if (any(lessThan(module, ivec2(1))) || any(greaterThan(module, ivec2(8)))) return white;
  module -= 2;
  if (any(lessThan(module, ivec2(0))) || any(greaterThan(module, ivec2(5)))) return black;
  int bit = 35 - (module.y * 6 + module.x);
  uint bits = bit < 32 ? code.y >> bit : code.z >> (bit - 32);
  return (bits & 1u) == 0u ? black : white;
}

void main() {
  if (code.x == plain) {
    pixel = vec4(vec3(white), 1.0);
    return;
  }
  // The mean over a pixel's footprint.
  vec2 across = dFdx(at), down = dFdy(at);
  vec4 sum = vec4(0.0);
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j) {
      vec2 place = at + across * (0.25 * float(i) - 0.375) + down * (0.25 * float(j) - 0.375);
      if (code.x == pattern) {
        sum += vec4(vec3(tag(place)), 1.0);
      } else if (dot(place, place) <= 1.0) {
        sum += vec4(dot(place, place) > 0.72 ? 0.55 * color : color, 1.0);
      }
    }
  }
  if (sum.w == 0.0) discard;
  pixel = vec4(sum.rgb / sum.w, sum.w / 16.0);
}
)";

// A line is a strip of constant width in the picture.
const char* const line_vertex = R"(
layout(location = 0) in vec3 start;
layout(location = 1) in vec3 end;
layout(location = 2) in vec3 line_color;
flat out vec3 color;

void main() {
  color = line_color;
  vec4 from = clip_from_camera * vec4(start, 1.0), to = clip_from_camera * vec4(end, 1.0);
  vec2 width = ground.yw;
  vec2 along = (to.xy / to.w - from.xy / from.w) / width;
  along = dot(along, along) > 0.0 ? normalize(along) : vec2(1.0, 0.0);
  gl_Position = (gl_VertexID & 1) == 0 ? from : to;
  vec2 side = 0.5 * width * vec2(-along.y, along.x);
  gl_Position.xy += ((gl_VertexID & 2) == 0 ? -side : side) * gl_Position.w;
  gl_Position.z *= 1.0003;  // in front of the surface that it ends on
}
)";

const char* const line_fragment = R"(
flat in vec3 color;
layout(location = 0) out vec4 pixel;

void main() { pixel = vec4(color, 1.0); }
)";

}  // namespace ziggurat::render::shaders
