-- Drives straight on; near an obstacle it turns left for a while.

local NEAR = 0.1  -- reading of a sensor
local TURN = 13   -- ticks that a turn takes

local left_to_turn

function init()  -- Init()
  left_to_turn = 0
end

reset = init  -- Reset()

function step()  -- ControlStep()
  for _, sensor in ipairs(robot.proximity) do
    local is_ahead = math.abs(sensor.angle) < 1.2
    if is_ahead and sensor.value > NEAR and left_to_turn == 0 then left_to_turn = TURN end
  end
  local speed = tonumber(robot.params.speed)  -- [cm/s]
  if left_to_turn > 0 then
    left_to_turn = left_to_turn - 1
    robot.wheels.set_velocity(-speed, speed)
  else
    robot.wheels.set_velocity(speed, speed)
  end
end
