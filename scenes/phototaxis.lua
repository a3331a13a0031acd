-- Drives straight on until it has seen a light for a while, then towards it, and stops where the floor is dark.

local speed = 10  -- [cm/s]
local while_seen = 25  -- [ticks] so that it passes the corner that hid the light
local tick, seen, has_arrived = 0, 0, false

function init()
   robot.colored_blob_omnidirectional_camera.enable()
   robot.distance_scanner.set_rpm(30)
end

-- The direction of the light, from the robot's front to the left [rad], and how bright it is.
local function light()
   local x, y = 0, 0
   for _, sensor in ipairs(robot.light) do
      x = x + sensor.value * math.cos(sensor.angle)
      y = y + sensor.value * math.sin(sensor.angle)
   end
   return math.atan(y, x), math.sqrt(x * x + y * y)
end

function step()
   tick = tick + 1
   if has_arrived then return end
   local direction, brightness = light()
   local sees = brightness > 0
   robot.leds.set_all_colors(sees and "yellow" or "black")
   seen = sees and seen + 1 or 0
   local turn = seen > while_seen and math.max(-1, math.min(1, 2 * direction)) or 0
   robot.wheels.set_velocity(speed * (1 - turn), speed * (1 + turn))
   if robot.motor_ground[1].value < 0.5 then
      has_arrived = true
      robot.wheels.set_velocity(0, 0)
      local blob = robot.colored_blob_omnidirectional_camera[1]
      local red = blob and blob.color.red or "no"
      log("arrived at tick ", tick, ", ", #robot.distance_scanner.long_range, " long rays, red of the blob: ", red)
   end
end
