-- Builds a staircase of three steps, 1 + 2 + 3 blocks, beside an existing block, which is lit in
-- red. Unlit blocks are material; a placed block is lit in the colour of its column, so the
-- structure itself stores the progress.
--
-- The robot uses the odometry of its wheels in a frame of the structure, and corrects it whenever
-- it sees a lit face. It does not know its start or the position of any block.

local builder = require "builder"

local pitch = 0.078         -- distance of columns: magnets of neighbours must not join [m]
local clearance = 0.03      -- lift, on approach without a block
local gap = 0.003           -- over the block when the magnets are energised
local travel = 0.075        -- lift, with a block, out of the camera's sight
local hub = 0.42            -- distance before the first column where the robot looks around

local colors = {{"red", {255, 0, 0}}, {"green", {0, 255, 0}}, {"blue", {0, 0, 255}}}
local plan = {{column = 2, level = 1}, {column = 3, level = 1}, {column = 2, level = 2},
              {column = 3, level = 2}, {column = 3, level = 3}}

local states = {}
local state, since = "start", 0  -- and its age in ticks
local step_of_plan = 1
local target                     -- {x, y, yaw}: the face to approach, in the structure's frame
local payload                    -- of the visible face of the carried block
local arrived                    -- the state after the hub
local turned = 0                 -- while looking around [rad]
local turning = 1                -- to the left

local function seconds() return since * builder.tick end
local function task() return plan[step_of_plan] end

---------------------------------------------------------------------------------------- places

-- A seen face, in the structure's frame.
local function place_of(face)
  local pose = builder.pose
  local c, s = math.cos(pose.yaw), math.sin(pose.yaw)
  return {x = pose.x + c * face.forward - s * face.left,
          y = pose.y + s * face.forward + c * face.left,
          yaw = builder.wrapped(pose.yaw + face.heading)}
end

-- A place in the structure's frame, as a face in the robot's frame.
local function face_of(place)
  local pose = builder.pose
  local c, s = math.cos(pose.yaw), math.sin(pose.yaw)
  local dx, dy = place.x - pose.x, place.y - pose.y
  return {forward = c * dx + s * dy, left = -s * dx + c * dy,
          heading = builder.wrapped(place.yaw - pose.yaw)}
end

local function column_of(face)
  if not face.color then return 0 end
  for i, color in ipairs(colors) do
    local want = color[2]
    if face.color.red == want[1] and face.color.green == want[2] and face.color.blue == want[3] then
      return i
    end
  end
  return 0
end

local function on_floor(face) return math.abs(face.up) < 0.02 end

-- The columns' front faces: their places, and the number on their lowest tag, which differs from
-- the other sides. The first is the origin of the structure's frame.
local fronts = {{x = 0, y = 0, yaw = 0}}

-- Corrects the odometry by the nearest front in sight, or by one column's only: the assumed places
-- of the columns have errors of millimetres, different for each.
local function find_oneself(faces, only)
  for _, face in ipairs(faces) do
    local column = column_of(face)
    local front = fronts[column]
    if front and (not only or column == only) and on_floor(face) and face.forward < 0.6 and face.payload == front.payload then
      local pose = builder.pose
      pose.yaw = front.yaw - face.heading
      local c, s = math.cos(pose.yaw), math.sin(pose.yaw)
      pose.x = front.x - (c * face.forward - s * face.left)
      pose.y = front.y - (s * face.forward + c * face.left)
      return
    end
  end
end

local function nearest_unlit(faces)
  for _, face in ipairs(faces) do
    if on_floor(face) and not face.color and math.abs(face.heading) < 0.9 then
      return face, place_of(face)
    end
  end
end

-- The seen face at a place, if any.
local function seen_at(faces, place)
  for _, face in ipairs(faces) do
    local there = place_of(face)
    if on_floor(face) and math.abs(there.x - place.x) < 0.03 and math.abs(there.y - place.y) < 0.03
       and math.abs(builder.wrapped(there.yaw - place.yaw)) < 0.5 then
      return face, there
    end
  end
end

---------------------------------------------------------------------------------------- driving

-- Drives to a point; true when it has arrived.
local function drive_to(x, y)
  local face = face_of({x = x, y = y, yaw = 0})
  local distance = math.sqrt(face.forward ^ 2 + face.left ^ 2)
  if distance < 0.02 then
    builder.stop()
    return true
  end
  local bearing = math.atan(face.left, face.forward)
  if math.abs(bearing) > 0.2 then
    builder.drive(0, math.max(-0.4, math.min(0.4, 1.5 * bearing)))
  else
    builder.drive(math.min(0.06, math.max(0.015, distance)), 1.5 * bearing)
  end
end

-- Turns on the spot to a direction; true when it has arrived.
local function turn_to(yaw)
  local error = builder.wrapped(yaw - builder.pose.yaw)
  if math.abs(error) < 0.02 then
    builder.stop()
    return true
  end
  builder.drive(0, math.max(-0.4, math.min(0.4, 2 * error)) + (error > 0 and 0.03 or -0.03))
end

-- Turns to both sides, each time farther, from its present direction.
local function look_around()
  builder.drive(0, 0.35 * turning)
  turned = turned + 0.35 * builder.tick
  if turned > 6.6 then turning, turned = -turning, 0 end
end

------------------------------------------------------------------------------- fetching a block

function states.start(faces)
  builder.current(-1)
  builder.lift_to(clearance, 0.05)
  for _, face in ipairs(faces) do
    if column_of(face) == 1 and math.abs(face.heading) < 0.7 then
      fronts[1].payload = face.payload
      return "seek_block"
    end
  end
  look_around()
end

function states.to_hub(faces)
  if drive_to(-hub, 0) then return arrived end
end

function states.seek_block(faces)
  builder.lift_to(clearance, 0.05)
  local face, place = nearest_unlit(faces)
  if face and face.forward < 0.8 then
    builder.stop()
    target = place
    return "line_up"
  end
  look_around()
end

-- To a point on the line in front of the target's face, from which the approach is easy.
function states.line_up(faces)
  local _, place = seen_at(faces, target)
  target = place or target
  local face = face_of(target)
  if face.forward > 0.15 and math.abs(builder.offset(face)) < 0.15 * (face.forward - 0.1)
     and math.abs(face.heading) < 0.3 then
    return "face_block"
  end
  local away = 0.2
  if drive_to(target.x - away * math.cos(target.yaw), target.y - away * math.sin(target.yaw)) then
    return "face_block"
  end
end

function states.face_block(faces)
  local face, place = seen_at(faces, target)
  if place then
    target = place
    return "approach_block"
  end
  if turn_to(math.atan(target.y - builder.pose.y, target.x - builder.pose.x)) then
    if seconds() > 3 then return "seek_block" end
  end
end

function states.approach_block(faces)
  local face, place = seen_at(faces, target)
  target = place or target
  if face then payload = face.payload end
  local outcome = builder.dock_at(face_of(target), 0.05, true)
  if outcome == "docked" then return "lower" end
  if outcome == "askew" then return "retreat" end
end

function states.retreat()
  builder.drive(-0.05, 0)
  if seconds() > 2.5 then
    arrived = "seek_block"
    return "to_hub"
  end
end

function states.lower()
  if builder.lift_to(gap - 0.0005, 0.03) then return "energise" end
end

function states.energise()
  builder.current(math.min(1, -1 + seconds()))
  if seconds() > 2.5 then return builder.holds() and "raise" or "let_go" end
end

function states.let_go()
  builder.current(-1)
  if builder.lift_to(clearance, 0.03) then return "retreat" end
end

function states.raise()
  if builder.lift_to(travel, 0.03) then
    builder.current(0)
    builder.loaded = builder.holds()
    return builder.loaded and "leave" or "let_go"
  end
end

-- Sends the block its column; it lights up.
function states.leave()
  robot.radios.nfc.tx_data({task().column})
  builder.drive(-0.05, 0)
  if seconds() > 2 then
    arrived = "seek_column"
    return "to_hub"
  end
end

------------------------------------------------------------------------------- placing a block

-- The column to steer by, and the distance to the left of it.
local function reference()
  if task().level == 1 then return task().column - 1, pitch end
  return task().column, 0
end

local function seen_column(faces, column)
  for _, face in ipairs(faces) do
    if column_of(face) == column and on_floor(face) and face.payload == fronts[column].payload then
      return face
    end
  end
end

-- Turns the shorter way to the assumed direction of the structure, and looks around for it.
function states.seek_column(faces)
  local column = reference()
  if seconds() <= builder.tick then turning = builder.wrapped(builder.pose.yaw) > 0 and -1 or 1 end
  if seen_column(faces, column) then
    builder.stop()
    return "line_up_column"
  end
  look_around()
end

local function refresh_target(faces)
  local column, shift = reference()
  local face = seen_column(faces, column)
  if not face then return end
  local place = place_of(face)
  target = {x = place.x - shift * math.sin(place.yaw), y = place.y + shift * math.cos(place.yaw),
            yaw = place.yaw}
end

function states.line_up_column(faces)
  refresh_target(faces)
  if not target then return "seek_column" end
  if drive_to(target.x - 0.32 * math.cos(target.yaw), target.y - 0.32 * math.sin(target.yaw)) then
    return "face_column"
  end
end

-- Looks at the column to steer by, which corrects the odometry, then in the target's direction.
function states.face_column(faces)
  refresh_target(faces)
  local column = reference()
  if not seen_column(faces, column) and seconds() < 12 then
    local front, pose = fronts[column], builder.pose
    if turn_to(math.atan(front.y - pose.y, front.x - pose.x)) then look_around() end
  elseif turn_to(target.yaw) then
    return "approach_column"
  end
end

function states.approach_column(faces)
  builder.lift_to(travel + math.max(0, task().level - 2) * builder.block, 0.05)
  refresh_target(faces)
  local beside = task().level == 1
  local outcome = builder.dock_at(face_of(target), 0.05, not beside)
  if outcome == "docked" then return "place" end
  if outcome == "askew" then return "retreat_column" end
end

function states.retreat_column()
  builder.drive(-0.05, 0)
  if seconds() > 5 then
    arrived = "seek_column"
    return "to_hub"
  end
end

function states.place()
  local height = (task().level - 1) * builder.block
  if builder.lift_to(math.max(0.0002, height - 0.0002), 0.01) then return "release" end
end

function states.release(faces)
  builder.current(math.max(-1, -2 * seconds()))
  if seconds() > 1.5 then return "rise" end
end

function states.rise()
  builder.loaded = false
  if builder.lift_to((task().level - 1) * builder.block + 0.03, 0.02) then return "back_off" end
end

function states.back_off(faces)
  builder.drive(-0.05, 0)
  if seconds() < 5 then return end
  builder.stop()
  if task().level == 1 then
    fronts[task().column] = {x = target.x, y = target.y, yaw = target.yaw, payload = payload}
  end
  step_of_plan = step_of_plan + 1
  if not task() then return "done" end
  arrived = "seek_block"
  return "to_hub"
end

function states.done() builder.stop() end

function init() log("start") end

function step()
  since = since + 1
  builder.reckon()
  local faces = builder.faces()
  find_oneself(faces, state == "approach_column" and reference() or nil)
  local next_state = states[state](faces)
  if next_state then
    state, since, turned = next_state, 0, 0
    log(state, " ", step_of_plan)
  end
  builder.move_lift()
end
