local radius, goal = 0.03, 1  -- of a wheel; how far to drive [m]

function init() end

function step()
  local way = radius * robot.joints.front_left.encoder
  local speed = math.min(0.3, 2 * (goal - way))  -- [m/s]: slower near the goal
  for _, wheel in pairs(robot.joints) do
    wheel.set_target(speed / radius)  -- [rad/s]
  end
  log(string.format("%.3f m", way))
end
