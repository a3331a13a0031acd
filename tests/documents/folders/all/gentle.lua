function init()
  robot.wheels.set_velocity(5 * tonumber(robot.params.gain), 5 * tonumber(robot.params.gain))
end
function step() end
