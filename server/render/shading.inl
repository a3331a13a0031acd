// SPDX-License-Identifier: MIT
// The loops of Kernel; lanes.inl tells which files include this.

#include "render/lanes.inl"

constexpr Float3 horizon{0.74f, 0.79f, 0.84f}, zenith{0.30f, 0.45f, 0.66f};

ZIGGURAT_INLINE Lanes lane_numbers() { return Lanes{0, 1, 2, 3, 4, 5, 6, 7}; }
ZIGGURAT_INLINE Mask lanes_below(unsigned count) {
  return Mask{0, 1, 2, 3, 4, 5, 6, 7} < static_cast<int>(count);
}

ZIGGURAT_INLINE Lanes mixed(float a, float b, const Lanes& part) { return a + (b - a) * part; }
ZIGGURAT_INLINE Point mixed(const Float3& a, const Float3& b, const Lanes& part) {
  return {mixed(a[0], b[0], part), mixed(a[1], b[1], part), mixed(a[2], b[2], part)};
}

/// The power 1 / 2.2, to within half a step of 8 bits: square roots are a tenth of the work.
ZIGGURAT_INLINE Lanes shown(const Lanes& light) {
  const Lanes half = square_root(clamped(light)), quarter = square_root(half);
  return 0.79608f * half + 0.28361f * quarter - 0.07969f * square_root(quarter);
}
ZIGGURAT_INLINE Point shown(const Point& light) {
  return {shown(light.x), shown(light.y), shown(light.z)};
}

/// @param a  beyond a million and what is not a number count as that
ZIGGURAT_INLINE int integer_below(float a) {
  constexpr float most = 1e6f;
  a = !(a > -most) ? -most : a < most ? a : most;
  const int cut = static_cast<int>(a);
  return cut - (static_cast<float>(cut) > a ? 1 : 0);
}

/// The share of 3 x 3 lookups that the sun reaches, each between four texels: 4 x 4 texels with
/// weights. @param x, y  [texels] from the first one's centre
static inline float lit_share(const ShadowMap& map, float x, float y, float depth) {
  const int column = integer_below(x), row = integer_below(y);
  if (depth <= map.nearest(column, row)) return 1;
  const float part_x = x - static_cast<float>(column), part_y = y - static_cast<float>(row);
  const Four weights{1 - part_x, 1, 1, part_x};
  const float rows[4] = {1 - part_y, 1, 1, part_y};
  Four sum{0, 0, 0, 0};
  for (int i = 0; i < 4; ++i) {
    const float* texels = map.texels(column - 1, row - 1 + i);
    const FourMask lit = depth <= *reinterpret_cast<const UnalignedFour*>(texels);
    sum += rows[i] * reinterpret_cast<Four>(lit & reinterpret_cast<FourMask>(weights));
  }
  return (sum[0] + sum[1] + sum[2] + sum[3]) * (1.0f / 9);
}

ZIGGURAT_INLINE Lanes row_of(const Matrix4& m, int row, const Point& p) {
  return m[row] * p.x + m[row + 4] * p.y + m[row + 8] * p.z + m[row + 12];
}

/// Sunlight that falls on a surface, 0 to 1.
/// @param wanted  lanes that are looked at
ZIGGURAT_INLINE Lanes sunlight(const Frame& frame, const Point& position, const Point& normal,
                               const Mask& wanted) {
  Lanes lit = larger(dot(frame.sun, normal), all(0));
  if (!(frame.shadow_texel > 0)) return lit;
  const Point raised = position + normal * all(1.5f * frame.shadow_texel);
  constexpr float size = shadow_size, beyond = 3;
  const Lanes x = row_of(frame.light_from_camera, 0, raised) * size - 0.5f;
  const Lanes y = row_of(frame.light_from_camera, 1, raised) * size - 0.5f;
  const Lanes depth = smaller(row_of(frame.light_from_camera, 2, raised), all(1));
  const Mask is_on_map = wanted & (lit > 0) & (x > -beyond) & (y > -beyond) &
                         (x < size + beyond - 1) & (y < size + beyond - 1);
  if (!any(is_on_map)) return lit;
  for (int i = 0; i < lane_count; ++i) {
    if (is_on_map[i]) lit[i] *= lit_share(*frame.shadows, x[i], y[i], depth[i]);
  }
  return lit;
}

ZIGGURAT_INLINE Point shaded(const Frame& frame, const Point& albedo, const Point& position,
                             const Point& normal, const Mask& wanted) {
  const Lanes sunny = sunlight(frame, position, normal, wanted);
  const Point ambient =
      mixed({0.30f, 0.28f, 0.26f}, {0.46f, 0.50f, 0.56f}, 0.5f + 0.5f * dot(frame.up, normal));
  const Point halfway = unit(same(frame.sun) - unit(position));
  Lanes gloss = larger(dot(normal, halfway), all(0));
  gloss *= gloss;
  gloss *= gloss;
  gloss *= gloss;  // the power 8
  const Lanes power_16 = gloss * gloss;
  gloss *= 0.10f * power_16 * power_16 * sunny;
  return {albedo.x * (ambient.x + 0.72f * sunny) + gloss,
          albedo.y * (ambient.y + 0.68f * sunny) + gloss,
          albedo.z * (ambient.z + 0.62f * sunny) + gloss};
}

/// Pixels of a run, eight at a time.
struct Here {
  unsigned x;      ///< of the first
  Mask wanted;     ///< those of the run
  Lanes to_right;  ///< slopes of the rays through their centres
  float down;
};

ZIGGURAT_INLINE Point point_at(const Here& here, const Lanes& z) {
  return {here.to_right * z, here.down * z, z};
}

/// Change of a coordinate xyz . point + w over a pixel, across and down, on a plane.
/// @param a, b  change of depth [1/(m px)];  @param product  xyz . point
struct Change {
  Lanes across, down;
};
ZIGGURAT_INLINE Change change_of(const Frame& frame, const float* xyz, const Lanes& product,
                                 const Lanes& a, const Lanes& b, const Lanes& z) {
  const auto fx = static_cast<float>(1 / frame.focal_x), fy = static_cast<float>(1 / frame.focal_y);
  return {z * (xyz[0] * fx - a * product), z * (xyz[1] * fy - b * product)};
}

ZIGGURAT_INLINE Lanes sum_of_magnitudes(const Change& change) {
  return magnitude(change.across) + magnitude(change.down);
}

ZIGGURAT_INLINE Point sky_color(const Frame& frame, const Here& here) {
  const Point ray{here.to_right, all(here.down), all(1)};
  const Lanes slope = dot(frame.up, ray) / square_root(dot(ray, ray));
  const Lanes root = square_root(smaller(magnitude(slope), all(1)));
  return shown(mixed(horizon, zenith, root * square_root(root)));
}

/// Mean of stripes over a pixel's footprint, -1 to 1, but for a factor. @param w  the footprint
ZIGGURAT_INLINE Lanes stripes(const Lanes& place, const Lanes& w) {
  const Lanes low = (place - 0.5f * w) * 0.5f, high = (place + 0.5f * w) * 0.5f;
  return magnitude(low - whole_below(low) - 0.5f) - magnitude(high - whole_below(high) - 0.5f);
}

/// A colour of the floor's own, as linear light, and how much it covers.
struct Paint {
  float color[3];
  float cover;
};

/// @param u, v  0 to 1 over the arena;  @param is_small  its pixels are, beside ours
static inline Paint paint_at(const FloorPicture& picture, float u, float v, bool is_small) {
  const auto within = [](float at, unsigned count) {
    return at < 0 ? 0u : at >= static_cast<float>(count) ? count - 1 : static_cast<unsigned>(at);
  };
  // The mean of four, or the one.
  const float shift = is_small ? 0.5f : 0;
  const float x = u * static_cast<float>(picture.width) - shift;
  const float y = v * static_cast<float>(picture.height) - shift;
  const float part_x = is_small ? x - static_cast<float>(integer_below(x)) : 0;
  const float part_y = is_small ? y - static_cast<float>(integer_below(y)) : 0;
  float rgba[4] = {0, 0, 0, 0};
  for (int i = 0; i < (is_small ? 4 : 1); ++i) {
    const bool second = (i & 1) != 0, upper = (i & 2) != 0;
    const unsigned column = within(second ? x + 1 : x, picture.width);
    const unsigned row = within(upper ? y + 1 : y, picture.height);
    const std::uint8_t* from = &picture.rgba[4 * (std::size_t{row} * picture.width + column)];
    const float weight = (second ? part_x : 1 - part_x) * (upper ? part_y : 1 - part_y);
    for (int channel = 0; channel < 4; ++channel) rgba[channel] += weight * from[channel];
  }
  Paint paint{{0, 0, 0}, rgba[3] / 255};
  for (int channel = 0; channel < 3; ++channel) {
    paint.color[channel] = picture.light[static_cast<unsigned>(rgba[channel] + 0.5f)];
  }
  return paint;
}

ZIGGURAT_INLINE Point floor_color(const Frame& frame, const Here& here) {
  const Float3& up = frame.up;
  const Lanes inverse = (up[0] * here.to_right + (up[1] * here.down + up[2])) * (-1 / frame.eye[2]);
  const Lanes z = 1.0f / larger(inverse, all(1e-6f));
  const Point position = point_at(here, z);
  const Lanes along_x = dot(frame.right, position), along_y = dot(frame.ahead, position);
  const Lanes x = along_x + frame.eye[0], y = along_y + frame.eye[1];
  const Lanes a = all(static_cast<float>(frame.floor_depth.a));
  const Lanes b = all(static_cast<float>(frame.floor_depth.b));
  const Lanes width_x =
      larger(sum_of_magnitudes(change_of(frame, &frame.right[0], along_x, a, b, z)), all(1e-6f));
  const Lanes width_y =
      larger(sum_of_magnitudes(change_of(frame, &frame.ahead[0], along_y, a, b, z)), all(1e-6f));
  const float per_tile = 1 / frame.tile;
  const Lanes checks = stripes(x * per_tile, width_x * per_tile) *
                       stripes(y * per_tile, width_y * per_tile) /
                       (width_x * width_y * (per_tile * per_tile));
  const Lanes contrast = (0.035f * 4) * checks;
  const Lanes from_center_x = x - frame.arena_center[0], from_center_y = y - frame.arena_center[1];
  const Lanes beyond = larger((magnitude(from_center_x) - frame.arena_half[0]) / width_x,
                              (magnitude(from_center_y) - frame.arena_half[1]) / width_y);
  const Lanes inside = clamped(0.5f - beyond);
  Point albedo = mixed({0.40f, 0.41f, 0.42f}, {0.56f, 0.57f, 0.58f}, inside) * (1.0f + contrast);
  if (frame.painting) {  // a little darker than its colours, because light adds to them
    const float pixel = 2 * frame.arena_half[0] / static_cast<float>(frame.painting->width);
    for (int i = 0; i < lane_count; ++i) {
      const Paint paint = paint_at(
          *frame.painting, from_center_x[i] / (2 * frame.arena_half[0]) + 0.5f,
          from_center_y[i] / (2 * frame.arena_half[1]) + 0.5f, larger(width_x, width_y)[i] > pixel);
      const float part = paint.cover * inside[i];
      albedo.x[i] += (0.9f * paint.color[0] - albedo.x[i]) * part;
      albedo.y[i] += (0.9f * paint.color[1] - albedo.y[i]) * part;
      albedo.z[i] += (0.9f * paint.color[2] - albedo.z[i]) * part;
    }
  }
  const Point normal = same(up) * all(frame.eye[2] >= 0 ? 1.0f : -1.0f);
  Point light = shaded(frame, albedo, position, normal, here.wanted);
  const float height = frame.eye[2] < 0 ? -frame.eye[2] : frame.eye[2];
  const float half_x = frame.arena_half[0], half_y = frame.arena_half[1];
  const float extent = __builtin_sqrtf(half_x * half_x + half_y * half_y) + height;
  const Lanes into_haze = square_root(dot(position, position)) - 2 * extent;
  if (any(into_haze > 0)) {
    const Lanes haze = 1.0f - decayed(larger(into_haze, all(0)) * (1 / (6 * extent)));
    light = light + (same(horizon) - light) * haze;
  }
  return shown(light);
}

/// Normals and depths of a face, and its change of depth.
struct Touched {
  Point position, normal;
  Lanes a, b;
};

ZIGGURAT_INLINE Touched touched(const Frame& frame, const Surface& surface, const Here& here,
                                unsigned row) {
  const auto fx = static_cast<float>(1 / frame.focal_x), fy = static_cast<float>(1 / frame.focal_y);
  if (surface.kind != Surface::Kind::round) {
    const auto start = static_cast<float>(surface.depth.at(here.x + 0.5, row + 0.5));
    const auto a = static_cast<float>(surface.depth.a), b = static_cast<float>(surface.depth.b);
    const Lanes z = 1.0f / larger(start + a * lane_numbers(), all(1e-9f));
    return {point_at(here, z), same(surface.normal), all(a), all(b)};
  }
  // The ray's nearest point to the centre or axis, and from there back to the surface.
  const Point ray{here.to_right, all(here.down), all(1)};
  const Point across = ray - same(surface.axis) * dot(surface.axis, ray);
  const Lanes square = larger(dot(across, across), all(1e-12f));
  const Lanes nearest = dot(surface.center, across) / square;
  const Point miss = across * nearest - same(surface.center);
  const float radius = surface.radius;
  const Lanes inside = larger(radius * radius - dot(miss, miss), all(0));
  const Lanes z = nearest - square_root(inside / square);
  const Point position = point_at(here, z);
  const Point normal = unit(across * z - same(surface.center));
  const Lanes facing = 1.0f / smaller(dot(normal, position), all(-1e-9f));
  return {position, normal, normal.x * facing * fx, normal.y * facing * fy};
}

/// Edges are drawn a little darker, so that blocks on blocks can be told apart.
ZIGGURAT_INLINE Lanes edge_line(const Frame& frame, const Surface& surface, const Touched& at) {
  Lanes nearest = all(1e30f), footprint = all(0);
  const auto add = [&](const Lanes& coordinate, float half, const Lanes& change)
      __attribute__((always_inline)) {
    const Lanes distance = magnitude(1.0f - magnitude(coordinate)) * half;
    const Mask is_nearest = distance < nearest;
    nearest = chosen(is_nearest, distance, nearest);
    footprint = chosen(is_nearest, change * half, footprint);
  };
  const auto coordinate = [&](int i, Change& change) __attribute__((always_inline)) {
    const float* row = &surface.coordinates[i][0];
    const Lanes product = row[0] * at.position.x + row[1] * at.position.y + row[2] * at.position.z;
    change = change_of(frame, row, product, at.a, at.b, at.position.z);
    return product + row[3];
  };
  Change first, second;
  const Lanes x = coordinate(0, first), y = coordinate(1, second);
  if (surface.has_rim) {
    const Lanes length = square_root(x * x + y * y), inverse = 1.0f / larger(length, all(1e-9f));
    const Change change{(x * first.across + y * second.across) * inverse,
                        (x * first.down + y * second.down) * inverse};
    add(length, surface.half_size[0], sum_of_magnitudes(change));
  } else {
    add(x, surface.half_size[0], sum_of_magnitudes(first));
    add(y, surface.half_size[1], sum_of_magnitudes(second));
    Change third;
    const Lanes z = coordinate(2, third);
    add(z, surface.half_size[2], sum_of_magnitudes(third));
  }
  footprint = larger(footprint, all(1e-9f));
  const Lanes width = larger(all(0.012f * surface.smallest), 0.8f * footprint);
  return clamped((width - nearest) / footprint + 0.5f) *
         clamped(surface.smallest / (24.0f * footprint));
}

ZIGGURAT_INLINE Point face_color(const Frame& frame, const Surface& surface, const Here& here,
                                 unsigned row) {
  const Touched at = touched(frame, surface, here, row);
  const Point albedo = same(surface.color) * (1.0f - 0.45f * edge_line(frame, surface, at));
  return shown(shaded(frame, albedo, at.position, at.normal, here.wanted));
}

/// 1 if a tag's module is white, else 0.
static inline unsigned is_white(const Surface& surface, int column, int row) {
  const auto within = [](int i) { return i < -1 ? 0 : i > 10 ? 11 : i + 1; };
  return (surface.white_modules[static_cast<unsigned>(within(row))] >> within(column)) & 1u;
}

/// White's share of a pixel's footprint, a parallelogram.
/// @param x, y  its centre [modules];  @param change  of x across and down, and of y
static inline float white_share(const Surface& surface, float x, float y, const float* change) {
  const auto size = [](float a) { return a < 0 ? -a : a; };
  const float wide = 0.46875f * (size(change[0]) + size(change[1]));
  const float high = 0.46875f * (size(change[2]) + size(change[3]));
  const int column = integer_below(x - wide), row = integer_below(y - high);
  if (integer_below(x + wide) == column && integer_below(y + high) == row) {
    return static_cast<float>(is_white(surface, column, row));
  }
  // Sixteen places, no two of them in one column or row of the pixel.
  unsigned count = 0;
  for (int i = 0; i < 16; ++i) {
    const float across = (static_cast<float>(i) - 7.5f) / 16;
    const float down = (static_cast<float>(5 * i % 16) - 7.5f) / 16;
    count += is_white(surface, integer_below(x + across * change[0] + down * change[1]),
                      integer_below(y + across * change[2] + down * change[3]));
  }
  return static_cast<float>(count) / 16;
}

ZIGGURAT_INLINE Point tag_color(const Frame& frame, const Surface& surface, const Here& here,
                                unsigned row) {
  const Touched at = touched(frame, surface, here, row);
  Lanes place[2];
  Change change[2];
  for (int i = 0; i < 2; ++i) {
    const float* xyz = &surface.coordinates[i][0];
    const Lanes product = xyz[0] * at.position.x + xyz[1] * at.position.y + xyz[2] * at.position.z;
    place[i] = product + xyz[3];
    change[i] = change_of(frame, xyz, product, at.a, at.b, at.position.z);
  }
  Lanes share = all(0);
  for (int i = 0; i < lane_count; ++i) {
    if (!here.wanted[i]) continue;
    const float changes[4] = {-5 * change[1].across[i], -5 * change[1].down[i],
                              -5 * change[0].across[i], -5 * change[0].down[i]};
    share[i] = white_share(surface, 5 - 5 * place[1][i], 5 - 5 * place[0][i], changes);
  }
  const Lanes shade = mixed(black_of_tags, white_of_tags, share);
  return {shade, shade, shade};
}

static void shade(const Frame& frame, const Surface* surface, unsigned row, const Run& run,
                  const Samples& samples, const RowColors& colors) {
  const auto down = static_cast<float>((row + 0.5 - frame.center_y) / frame.focal_y);
  const auto step = static_cast<float>(1 / frame.focal_x);
  for (unsigned x = run.begin; x < run.end; x += lane_count) {
    const auto start = static_cast<float>((x + 0.5 - frame.center_x) / frame.focal_x);
    const Here here{x, lanes_below(run.end - x), start + step * lane_numbers(), down};
    Point color;
    if (!surface) {
      color = run.number == sky_number ? sky_color(frame, here) : floor_color(frame, here);
    } else if (surface->kind == Surface::Kind::tag) {
      color = tag_color(frame, *surface, here, row);
    } else if (surface->kind == Surface::Kind::plain) {
      color = same(surface->color);
    } else {
      color = face_color(frame, *surface, here, row);
    }
    Mask count{};  // of samples, negative
    for (unsigned i = 0; i < 4; ++i) {
      count += load(&samples.numbers[samples.line(row, i) + x]) == static_cast<int>(run.number);
    }
    const Lanes weight = __builtin_convertvector(count & here.wanted, Lanes) * (-255.0f / 4);
    store(colors.red + x, load(colors.red + x) + color.x * weight);
    store(colors.green + x, load(colors.green + x) + color.y * weight);
    store(colors.blue + x, load(colors.blue + x) + color.z * weight);
  }
}

static void draw(const Polygon& polygon, Samples& samples) {
  const unsigned last = samples.first_row + samples.rows;
  const auto from =
      polygon.top > samples.first_row ? static_cast<unsigned>(polygon.top) : samples.first_row;
  const Mask number = Mask{} + static_cast<int>(polygon.surface);
  const Lanes steps = static_cast<float>(polygon.depth.a) * lane_numbers();
  const auto stride = static_cast<float>(polygon.depth.a * lane_count);
  for (unsigned row = from; row < last && row < polygon.bottom; ++row) {
    for (unsigned i = 0; i < 4; ++i) {
      const auto [begin, end] = covered(polygon, row + sample_y[i], sample_x[i], samples.width);
      const double start = polygon.depth.at(begin + sample_x[i], row + sample_y[i]);
      Lanes depth = static_cast<float>(start) + steps;
      float* depths = &samples.depths[samples.line(row, i)];
      std::uint32_t* numbers = &samples.numbers[samples.line(row, i)];
      for (unsigned x = begin; x < end; x += lane_count, depth += stride) {
        const Lanes before = load(depths + x);
        const Mask is_nearest = (depth > before) & lanes_below(end - x);
        store(depths + x, chosen(is_nearest, depth, before));
        store(numbers + x, chosen(is_nearest, number, load(numbers + x)));
      }
    }
  }
}

static void lay_floor(const Frame& frame, unsigned row, Samples& samples) {
  const DepthPlane& plane = frame.floor_depth;
  const Lanes steps = static_cast<float>(plane.a) * lane_numbers();
  const Mask number = Mask{} + static_cast<int>(floor_number);
  for (unsigned i = 0; i < 4; ++i) {
    const double y = row + sample_y[i];
    if (!(plane.at(0, y) > 0) && !(plane.at(samples.width, y) > 0)) continue;
    float* depths = &samples.depths[samples.line(row, i)];
    std::uint32_t* numbers = &samples.numbers[samples.line(row, i)];
    for (unsigned x = 0; x < samples.width; x += lane_count) {
      const Lanes depth = static_cast<float>(plane.at(x + sample_x[i], y)) + steps;
      const Lanes before = load(depths + x);
      const Mask is_nearest = depth > before;  // the sky's is 0
      store(depths + x, chosen(is_nearest, depth, before));
      store(numbers + x, chosen(is_nearest, number, load(numbers + x)));
    }
  }
}
