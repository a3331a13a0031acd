-- Drives to the end of the rail: gets faster slowly, then brakes in proportion to what is left.

local cruise, goal = 0.8, 2.0  -- [m/s], [m]
local acceleration = 1         -- [m/s^2]
local gain = tonumber(robot.params.gain)  -- [1/s]
local speed = 0

function init() end

function step()
  local left = goal - robot.joints.rail.encoder
  speed = math.min(speed + acceleration / 200, cruise, gain * left)
  robot.joints.rail.set_target(speed)
end

function reset() speed = 0 end
function destroy() end
