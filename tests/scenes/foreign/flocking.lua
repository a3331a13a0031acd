-- Each robot follows the sum of Lennard-Jones forces of its neighbours.
TARGET = 0
EPSILON = 100

function init()
  TARGET = tonumber(robot.params.target)
  robot.range_and_bearing.set_data(1, 7)
end

function lennard_jones(distance)
  local ratio = math.pow(TARGET / distance, 2)
  return -4 * EPSILON / distance * (ratio * ratio - ratio)
end

function step()
  local sum, nearest = vector2(), math.huge
  for i = 1, #robot.range_and_bearing do
    local packet = robot.range_and_bearing[i]
    if packet.data[1] == 7 then
      sum = sum + vector2(lennard_jones(packet.range), 0):rotate(packet.horizontal_bearing)
      nearest = math.min(nearest, packet.range)
    end
  end
  local heading = math.atan2(sum.y, sum.x)
  local speed = math.min(10, sum:length()) * math.cos(heading)
  local turn = math.max(-5, math.min(5, 5 * heading))
  robot.wheels.set_velocity(speed - turn, speed + turn)
  local yaw = robot.positioning.orientation:toeulerangles()
  log(string.format("nearest %d cm, heading %.2f, charge %.2f", nearest, yaw, robot.battery.available_charge))
end

function reset()
  init()
end

function destroy()
end
