-- The pose of a square tag from its four corners in one image.
--
-- A plane is seen through a homography. For a square that fills 0 ≤ u, v ≤ 1 of its plane the
-- homography has a closed form (Heckbert 1989), and its columns are, up to one scale, the square's
-- two edges and its first corner in the camera's frame (Zhang 2000). Corners without noise give the
-- pose exactly.

local tag_pose = {}

local function cross(a, b)
  return {a[2] * b[3] - a[3] * b[2], a[3] * b[1] - a[1] * b[3], a[1] * b[2] - a[2] * b[1]}
end

local function length(a) return math.sqrt(a[1] * a[1] + a[2] * a[2] + a[3] * a[3]) end

-- corners: four {x =, y =} [px], in the camera's order: (-,-), (-,+), (+,+), (+,-) of the
-- tag's own x and y. camera: {focal_length = {x, y}, principal_point = {x, y}} [px]. side: outer
-- edge [m]. Returns the tag's centre and its outward normal (unit) in the camera's frame: x right,
-- y down, z forward [m]; nothing if the corners are not a convex quadrilateral.
function tag_pose.solve(corners, camera, side)
  local x, y = {}, {}
  for i = 1, 4 do
    x[i] = (corners[i].x - camera.principal_point[1]) / camera.focal_length[1]
    y[i] = (corners[i].y - camera.principal_point[2]) / camera.focal_length[2]
  end
  -- u runs along the tag's x: from corner 1 to corner 4; v along its y: from corner 1 to corner 2.
  local dx1, dx2, sx = x[4] - x[3], x[2] - x[3], x[1] - x[4] + x[3] - x[2]
  local dy1, dy2, sy = y[4] - y[3], y[2] - y[3], y[1] - y[4] + y[3] - y[2]
  local determinant = dx1 * dy2 - dx2 * dy1
  if math.abs(determinant) < 1e-12 then return nil end
  local g = (sx * dy2 - dx2 * sy) / determinant
  local h = (dx1 * sy - sx * dy1) / determinant
  local edge_u = {x[4] - x[1] + g * x[4], y[4] - y[1] + g * y[4], g}
  local edge_v = {x[2] - x[1] + h * x[2], y[2] - y[1] + h * y[2], h}
  local length_u, length_v = length(edge_u), length(edge_v)
  local scale = 2 * side / (length_u + length_v)
  local first = {x[1], y[1], 1}
  local centre = {}
  for i = 1, 3 do centre[i] = scale * (first[i] + 0.5 * edge_u[i] + 0.5 * edge_v[i]) end
  local normal = cross(edge_u, edge_v)
  local size = length(normal)
  if size == 0 or centre[3] <= 0 then return nil end
  for i = 1, 3 do normal[i] = normal[i] / size end
  return centre, normal
end

return tag_pose
