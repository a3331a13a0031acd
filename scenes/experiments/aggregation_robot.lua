-- Goes to where beacons come from, and wanders while it hears none. Who has a radio sends beacons.

local SPEED = 10        -- [cm/s]
local NEAR = 30         -- a beacon at this range is near enough [cm]

local number = tonumber(robot.id:match("%d+$"))
local has_radio = number <= tonumber(robot.params.share) * tonumber(robot.params.robots) + 1e-9
local LEAVES = 0.003    -- how probable it is at a tick that a robot leaves those that it has found
local turn, turn_ticks = 0, 0
local leaving = 0       -- ticks for which it still goes away

function init()
  if has_radio then robot.range_and_bearing.set_data({1}) end
end

-- Sum of unit vectors to the beacons that are not near, in the robot's frame.
local function pull()
  local x, y, near = 0, 0, 0
  for _, packet in ipairs(robot.range_and_bearing) do
    if packet.data[1] == 1 then
      if packet.range > NEAR then
        x = x + math.cos(packet.horizontal_bearing)
        y = y + math.sin(packet.horizontal_bearing)
      else
        near = near + 1
      end
    end
  end
  return x, y, near
end

-- Away from what is close.
local function push()
  local x, y = 0, 0
  for _, ray in ipairs(robot.proximity) do
    x = x - ray.value * math.cos(ray.angle)
    y = y - ray.value * math.sin(ray.angle)
  end
  return x, y
end

local function wander()
  if turn_ticks == 0 then
    turn = robot.random.gaussian(0.6)
    turn_ticks = robot.random.uniform_int(10, 40)
  end
  turn_ticks = turn_ticks - 1
  return math.cos(turn), math.sin(turn)
end

function step()
  local x, y, near = pull()
  leaving = math.max(leaving - 1, 0)
  if x == 0 and y == 0 and near > 0 and leaving == 0 then
    if robot.random.bernoulli(LEAVES) == 0 then return robot.wheels.set_velocity(0, 0) end
    leaving = 150
  end
  if leaving > 0 or (x == 0 and y == 0) then x, y = wander() end
  local length = math.sqrt(x * x + y * y)
  local away_x, away_y = push()
  x, y = x / length + 2 * away_x, y / length + 2 * away_y
  local heading = math.atan(y, x)
  local forward = SPEED * math.max(0, math.cos(heading))
  local rotation = SPEED * math.max(-1, math.min(1, heading))
  robot.wheels.set_velocity(forward - 0.7 * rotation, forward + 0.7 * rotation)
end
