function init()
  robot.wheels.set_velocity(10 * tonumber(robot.params.gain), 10 * tonumber(robot.params.gain))
end
function step() end
