-- Drives the robot from place to place, around what it remembers and around other robots.

local builder = require "builder"
local memory = require "memory"
local odometry = require "odometry"
local path = require "path"
local traffic = require "traffic"

local travel = {}

local fastest, turn_rate = 0.18, 1  -- m/s, rad/s
local near = 0.1          -- in front of the robot's centre: so near it drives up to nothing unknown [m]

local goal                -- {x, y}
local points, planned     -- the way, and when it was found
local speed = 0
local blocked, patience = 0, 20    -- ticks
local evading = {ticks = 0, speed = 0}
local room_tried = -100   -- when it made room for a turn
local bumps = {}          -- unknown things it nearly drove into: {x, y, hard, soft, seen}
local best, best_at       -- least distance to the goal so far, and when
local waited = 0          -- ticks for which another robot has stood at the goal

local function here() return builder.pose end

local function plan_way()
  local list = memory.obstacles({})
  traffic.obstacles(here(), list)
  for n = #bumps, 1, -1 do
    if memory.now - bumps[n].seen > 300 then table.remove(bumps, n) else list[#list + 1] = bumps[n] end
  end
  points, planned = path.find(here(), goal, list), memory.now
end

-- Whether a remembered block is so near in front of the robot that driving on would push it.
local function column_ahead()
  local c, s = math.cos(here().yaw), math.sin(here().yaw)
  for _, thing in ipairs(memory.obstacles({})) do
    local dx, dy = thing.x - here().x, thing.y - here().y
    local forward, left = c * dx + s * dy, -s * dx + c * dy
    local front, reach = 0.1, 0.11
    if thing.hard < 0.15 then front, reach = 0.03, 0.108 end  -- the arm passes over it
    if forward > 0 and (forward - front) ^ 2 + left ^ 2 < reach ^ 2 then return true end
  end
end

-- Whether another robot stands at the goal, nearer than this one.
local function occupied(own_distance)
  for _, other in ipairs(traffic.others) do
    local point = traffic.place_of(here(), other)
    local distance = math.sqrt((point.x - goal.x) ^ 2 + (point.y - goal.y) ^ 2)
    if distance < math.min(0.27, own_distance) then return true end
  end
end

-- Drives or turns, if no robot and no block is in the way. False if one is.
local function move(wanted, turn)
  local other = wanted ~= 0 and traffic.blocked(wanted > 0 and 1 or -1)
  traffic.stopped = other and true or false
  if other or wanted > 0 and column_ahead() then
    speed = 0
    builder.stop()
    return false
  end
  speed = math.max(speed - 0.03, math.min(speed + 0.015, wanted))
  builder.drive(speed, turn)
  return true
end

local function rear_free()
  return math.min(builder.distance(6), builder.distance(7), builder.distance(8)) > 0.03
end

-- Moves straight for some ticks, out of somebody's way.
local function evade(direction, ticks)
  if direction < 0 and not rear_free() then direction = 1 end
  evading = {ticks = ticks, speed = 0.05 * direction}
end

local function evaded()
  if evading.ticks <= 0 then return false end
  evading.ticks = evading.ticks - 1
  local obstacle = evading.speed > 0 and builder.ahead() < near
                   or evading.speed < 0 and not rear_free()
  if obstacle or not move(evading.speed, 0) then
    builder.stop()
    evading.ticks = 0
  end
  if evading.ticks == 0 then points = nil end
  return true
end

-- Whether a column is so near that the robot would touch it when it turns; how far it is in front [m].
local function column_beside()
  for _, column in pairs(memory.columns) do
    local dx, dy = column.x - here().x, column.y - here().y
    if dx * dx + dy * dy < 0.16 ^ 2 then
      return dx * math.cos(here().yaw) + dy * math.sin(here().yaw)
    end
  end
end

-- Whether a dark block is so near that the robot would touch it when it turns on the spot; how far it is in front [m].
local function block_beside()
  local pivot = odometry.pivot()
  for _, block in ipairs(memory.material) do
    local dx, dy = block.x - pivot.x, block.y - pivot.y
    if dx * dx + dy * dy < 0.145 ^ 2 then return dx * math.cos(pivot.yaw) + dy * math.sin(pivot.yaw) end
  end
end

-- Before a turn on the spot: drives straight away from a block that is in the way; true while it does. It does not
-- try again for some time.
local function make_room()
  if memory.now < room_tried + 40 then return false end
  local forward = block_beside()
  if not forward then return false end
  room_tried = memory.now
  evade(forward > 0 and -1 or 1, 15)
  return true
end

-- Drives straight away from a robot or a column that is very near; true while it does.
local function keep_distance()
  if evading.ticks <= 0 and not traffic.working then
    local other = traffic.nearest()
    local near_by = other and (other.range < 0.27 or other.stopped and speed == 0 and other.range < 0.4)
    local forward = near_by and other.forward or column_beside()
    if forward then evade(forward > 0 and -1 or 1, 15) end
  end
  return evaded()
end

-- Drives the point about which the robot turns to one in the frame of memory; call it in every step. "there" when
-- it has arrived, "stuck" after 25 s without coming nearer, "occupied" when another robot has stood there for 2 s.
function travel.to(x, y)
  local pose = odometry.pivot()
  local distance = math.sqrt((x - pose.x) ^ 2 + (y - pose.y) ^ 2)
  if not goal or (goal.x - x) ^ 2 + (goal.y - y) ^ 2 > 0.03 ^ 2 then
    points, best = nil, nil
  end
  goal = {x = x, y = y}
  if not best or distance < best - 0.03 then best, best_at = distance, memory.now end
  if distance < 0.015 then
    builder.stop()
    travel.forget()
    return "there"
  end
  if memory.now - best_at > 250 then
    builder.stop()
    travel.forget()
    return "stuck"
  end
  if keep_distance() then return end
  local other = traffic.nearest()
  local age = points and memory.now - planned or math.huge
  if age > 50 or (other and other.range < 0.7 and age > 12) then plan_way() end
  if not points or distance < 0.5 and occupied(distance) then
    builder.stop()
    waited = waited + 1
    return waited > 20 and "occupied" or nil
  end
  waited = 0
  while #points > 1 and (points[1].x - pose.x) ^ 2 + (points[1].y - pose.y) ^ 2 < 0.09 ^ 2 do
    table.remove(points, 1)
  end
  local bearing = builder.wrapped(math.atan(points[1].y - pose.y, points[1].x - pose.x) - pose.yaw)
  local turn = math.max(-turn_rate, math.min(turn_rate, 1.8 * bearing))
  if math.abs(bearing) > 0.45 then
    if make_room() then return end
    speed = 0
    builder.drive(0, turn)
    return
  end
  if builder.ahead() < near then
    bumps[#bumps + 1] = {x = pose.x + 0.13 * math.cos(pose.yaw), y = pose.y + 0.13 * math.sin(pose.yaw),
                         hard = 0.13, soft = 0.18, seen = memory.now}
    evade(-1, 20)
    return
  end
  local wanted = math.min(fastest, math.max(0.02, distance)) * (1 - math.abs(bearing))
  if move(wanted, turn) then
    blocked = 0
    return
  end
  blocked = blocked + 1
  if blocked > patience then
    blocked, patience = 0, robot.random.uniform_int(10, 40)
    points = nil
    if column_ahead() or robot.random.bernoulli() == 1 then evade(-1, 15) end
  end
end

-- Turns on the spot to a direction in the frame of memory; true when it has arrived.
function travel.turn_to(yaw)
  if keep_distance() then return false end
  local error = builder.wrapped(yaw - here().yaw)
  if math.abs(error) < 0.03 then
    builder.stop()
    return true
  end
  if math.abs(error) > 0.45 and make_room() then return false end
  builder.drive(0, math.max(-turn_rate, math.min(turn_rate, 2 * error)) + (error > 0 and 0.03 or -0.03))
  return false
end

-- Stands, and keeps its distance.
function travel.wait()
  if not keep_distance() then builder.stop() end
end

-- Turns on the spot [rad/s], and keeps its distance.
function travel.spin(rate)
  if not keep_distance() and not make_room() then builder.drive(0, rate) end
end

function travel.forget() goal, points, best, speed, blocked, waited = nil, nil, nil, 0, 0, 0 end

return travel
