local radius = 0.03  -- [m]

function init()
  for name, wheel in pairs(robot.joints) do
    local speed = name:find("left") and 0.12 or 0.2  -- [m/s]: a circle to the left
    wheel.set_target(speed / radius)
  end
end

function step() end
