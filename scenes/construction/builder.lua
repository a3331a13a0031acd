-- Common functions of the construction robot's controllers: dimensions, wheels, lift, proximity
-- sensors, docking at a block with the camera. Distances in m, times in s, angles in rad; positions
-- in the robot's frame are {forward, left} of the point between the four wheels.

local here = (...):match("^(.*%.)") or ""
local tag_pose = require(here .. "tag_pose")

local builder = {}

-- Dimensions of the robot. They contain no position of a block.
builder.tick = 0.1                -- s between two steps
builder.block = 0.055             -- edge of a block
builder.tag_side = 0.024
builder.face_height = 0.0555      -- of the end effector's face above the floor, lift at 0
builder.reach = 0.080             -- from the robot's centre to the face of a held block
builder.wheel_radius = 0.025
local wheel_radius, half_track = builder.wheel_radius, 0.052
-- Rotation of the wheels / rotation of the robot, as they skid: without a block, and with one,
-- whose weight reduces the load on the rear wheels.
local slip = {[false] = 1.335, [true] = 1.12}
builder.loaded = false            -- for the odometry: whether the robot carries a block
local front_sensor = 0.065        -- position of the front proximity sensors
local camera_forward = 0.0055     -- position of the camera
local camera = {focal_length = {884, 884}, principal_point = {320, 180}}

--------------------------------------------------------------------------------------- wheels, lift

-- Speed [m/s] and turn to the left [rad/s].
function builder.drive(speed, turn)
  local skid = turn * half_track * slip[builder.loaded]
  local left, right = (speed - skid) / wheel_radius, (speed + skid) / wheel_radius
  robot.joints.base_wheel_fl.set_target(left)
  robot.joints.base_wheel_bl.set_target(left)
  robot.joints.base_wheel_fr.set_target(right)
  robot.joints.base_wheel_br.set_target(right)
end

function builder.stop() builder.drive(0, 0) end

-- The robot's pose by odometry: {x, y, yaw} in a frame that the controller chooses.
builder.pose = {x = 0, y = 0, yaw = 0}

-- Updates it from the rotation of the wheels; call it first in every step.
function builder.reckon()
  local joints, pose = robot.joints, builder.pose
  local left = (joints.base_wheel_fl.encoder + joints.base_wheel_bl.encoder) / 2
  local right = (joints.base_wheel_fr.encoder + joints.base_wheel_br.encoder) / 2
  local way = (left + right) / 2 * wheel_radius * builder.tick
  local turn = (right - left) / 2 * wheel_radius * builder.tick / half_track / slip[builder.loaded]
  pose.x = pose.x + way * math.cos(pose.yaw + turn / 2)
  pose.y = pose.y + way * math.sin(pose.yaw + turn / 2)
  pose.yaw = pose.yaw + turn
end

-- The equivalent angle within half a turn of 0.
function builder.wrapped(angle) return math.atan(math.sin(angle), math.cos(angle)) end

local lift = {height = 0, speed = 0, now = 0}

-- Moves the lift to a height with at most this speed. True when it has arrived.
function builder.lift_to(height, speed)
  lift.height, lift.speed = height, speed
  return math.abs(height - robot.joints.lift.encoder) < 3e-4
end

-- Moves or holds the lift; call it last in every step. It starts and stops slowly.
function builder.move_lift()
  local wanted = 3 * (lift.height - robot.joints.lift.encoder)
  wanted = math.max(-lift.speed, math.min(lift.speed, wanted))
  local change = 0.015  -- m/s in a step
  lift.now = math.max(lift.now - change, math.min(lift.now + change, wanted))
  robot.joints.lift.set_target(lift.now)
end

-- -1 cancels the end effector's permanent magnets, 0 leaves them, +1 doubles them.
function builder.current(current)
  for _, magnet in pairs(robot.magnets) do magnet.set_current(current) end
end

----------------------------------------------------------------------------------------- proximity

-- The sensors' calibration: distance [m] and counts.
local counts = {{0.0035, 65535}, {0.005, 32000}, {0.0075, 14222}, {0.01, 8000}, {0.015, 3556},
                {0.02, 2000}, {0.03, 889}, {0.04, 500}, {0.06, 222}, {0.08, 125}, {0.1, 80},
                {0.15, 36}, {0.2, 20}}

-- The distance for a sensor's reading [m]; infinity if there is no object.
function builder.distance(sensor)
  local reading = robot.proximity[sensor]
  for i = 2, #counts do
    if reading >= counts[i][2] then
      local near, far = counts[i - 1], counts[i]
      local share = (near[2] - math.min(reading, near[2])) / (near[2] - far[2])
      return near[1] + share * (far[1] - near[1])
    end
  end
  return math.huge
end

-- From the robot's centre to the nearest object in front of the deck; infinity beyond 0.2 m of it.
function builder.ahead()
  local nearest = math.min(builder.distance(1), builder.distance(2), builder.distance(12))
  return front_sensor + nearest
end

-- From the end effector's face down to the object below; the sensor is 4 mm inside.
function builder.below() return builder.distance(13) - 0.004 end

-- True if a block is attached to the end effector: all three sensors that look down touch it.
function builder.holds()
  return math.max(builder.distance(13), builder.distance(15), builder.distance(16)) < 0.0045
end

-------------------------------------------------------------------------------------------- camera

-- The colour of the LEDs around a tag, as {red, green, blue}; nil if they are off. They are 20 mm from the
-- tag's centre, in both directions; farther out are those of the neighbouring faces.
local function color_around(centre, normal)
  local along = centre[1] * normal[1] + centre[2] * normal[2] + centre[3] * normal[3]
  for _, led in ipairs(robot.cameras.camera.directional_led_detector) do
    local x = (led.center.x - camera.principal_point[1]) / camera.focal_length[1]
    local y = (led.center.y - camera.principal_point[2]) / camera.focal_length[2]
    local depth = along / (x * normal[1] + y * normal[2] + normal[3])  -- the ray meets the face
    local dx, dy, dz = x * depth - centre[1], y * depth - centre[2], depth - centre[3]
    if math.abs(dy) < 0.024 and dx * dx + dz * dz < 0.024 ^ 2 then return led.color end
  end
end

-- All seen faces that are upright, nearest first: {forward, left, up, heading, payload,
-- color}. up counts from the camera, heading is the direction into the face.
function builder.faces()
  local found = {}
  for _, tag in ipairs(robot.cameras.camera.tag_detector) do
    local centre, normal = tag_pose.solve(tag.corners, camera, builder.tag_side)
    if centre and math.abs(normal[2]) < 0.3 then
      found[#found + 1] = {
        forward = centre[3] + camera_forward, left = -centre[1], up = -centre[2],
        heading = math.atan(normal[1], -normal[3]), payload = tag.payload,
        color = color_around(centre, normal)}
    end
  end
  table.sort(found, function(a, b)
    if a.forward ~= b.forward then return a.forward < b.forward end
    return a.left < b.left
  end)
  return found
end

-- The nearest face at floor level that faces the robot; nil if the camera sees none.
function builder.nearest_face()
  for _, face in ipairs(builder.faces()) do
    if math.abs(face.up) < 0.02 and math.abs(face.heading) < 0.7 then return face end
  end
end

-- Distance of the robot to the left of the normal through a face's centre; of the point so far in front of its
-- centre, if that is given.
function builder.offset(face, ahead)
  return (face.forward - (ahead or 0)) * math.sin(face.heading) - face.left * math.cos(face.heading)
end

-- Turn rate that moves the robot onto that line with a distance constant of 3 cm, forwards or backwards. With the
-- point about which it turns, so far in front of its centre, that point moves there, sooner where it drives slowly.
local function steer(face, speed, pivot)
  local settle = pivot and math.max(0.018, 0.6 * speed) or 0.03
  local wanted = math.max(-0.25, math.min(0.25, builder.offset(face, pivot) / (2 * settle)))
  return math.abs(speed) * 2 / settle * (face.heading - (speed > 0 and wanted or -wanted))
end

-- Drives to a face; call it in every step with the present face. Returns "docked" when the face is
-- under the end effector, or at another distance from the robot's centre; "askew" if the robot came close
-- but is not on the line. With `touch` the proximity sensors measure the last part of the distance. `pivot`
-- is how far in front of the robot's centre the point is about which it turns, if that is known.
function builder.dock_at(face, fastest, touch, distance, pivot)
  local to_go = math.min(face.forward, touch and builder.ahead() or math.huge) -
                (distance or builder.reach)
  if to_go < 0.03 and (math.abs(builder.offset(face)) > 0.006 or math.abs(face.heading) > 0.12) then
    builder.stop()
    return "askew"
  end
  if to_go < 0.0005 then
    builder.stop()
    return "docked"
  end
  local speed = math.max(0.008, math.min(fastest, 1.2 * to_go))
  builder.drive(speed, steer(face, speed, pivot))
end

local unseen = 0           -- steps since the camera saw a face
local tracked = math.huge  -- about how far away the face is that it drives to

-- That face; nil if it is not in the image. `another` if the nearest is another one, farther away.
local function tracked_face()
  local face = builder.nearest_face()
  local another = face and face.forward > tracked + 0.05
  if another then face = nil end
  if face then tracked = face.forward end
  return face, another
end

-- The next face to drive to may be any.
function builder.forget_face() tracked = math.huge end

-- Drives to the nearest face, as above; "lost" if the camera sees none. "askew", too, if the face leaves
-- the image and the camera sees another, or if it is too far aside for the way that is left.
function builder.dock(fastest)
  local face, another = tracked_face()
  unseen = face and 0 or unseen + 1
  if not face then
    builder.stop()
    if another then return "askew" end
    if unseen > 5 then
      builder.forget_face()
      return "lost"
    end
    return
  end
  local to_go = face.forward - builder.reach
  if to_go < 0.15 and math.abs(builder.offset(face)) > 0.01 + 0.5 * to_go then return "askew" end
  local outcome = builder.dock_at(face, fastest, true)
  if outcome == "docked" then builder.forget_face() end
  return outcome
end

-- Drives backwards to the line in front of that face; call it in every step. True where an approach is
-- easy: 20 cm away and near the line, or far away.
function builder.back_away(speed)
  tracked = tracked + speed * builder.tick
  local face = tracked_face()
  builder.drive(-speed, face and steer(face, -speed) or 0)
  if not face or math.min(face.forward, builder.ahead()) < 0.2 then return false end
  return math.abs(builder.offset(face)) < 0.15 * (face.forward - 0.1) or face.forward > 0.5
end

return builder
