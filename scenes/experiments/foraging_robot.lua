-- Drives straight on, and turns away from what is close.

local SPEED = 15  -- [cm/s]
local turn_ticks = 0
local turn = 1

function init() end

function step()
  local front = 0
  for _, ray in ipairs(robot.proximity) do
    if math.abs(ray.angle) < 1 then front = math.max(front, ray.value) end
  end
  if front > 0 and turn_ticks == 0 then
    turn = robot.random.bernoulli() * 2 - 1
    turn_ticks = robot.random.uniform_int(5, 20)
  end
  if turn_ticks > 0 then
    turn_ticks = turn_ticks - 1
    robot.wheels.set_velocity(-turn * SPEED, turn * SPEED)
  else
    robot.wheels.set_velocity(SPEED, SPEED)
  end
end
