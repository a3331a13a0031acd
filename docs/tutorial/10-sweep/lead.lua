local radius = 0.03  -- [m]

function init()
  local inner = robot.random.uniform(0.08, 0.16)  -- another circle for each seed [m/s]
  for name, wheel in pairs(robot.joints) do
    local speed = name:find("left") and inner or 0.2
    wheel.set_target(speed / radius)
  end
end

function step() end
