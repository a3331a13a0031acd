-- Spawned robots turn on the spot, those of the scene stand.
local ticks = 0
function step()
  ticks = ticks + 1
  metric("ticks", ticks)
  if robot.id ~= "large" and robot.id ~= "small" then robot.wheels.set_velocity(-1, 1) end
end

function init() end
function reset() end
function destroy() end
