-- The foot-bot drives in a circle with its LEDs on. The eye-bot takes off, then flies to the middle of what it sees.

local pixels = 400 / math.tan(math.pi / 6)  -- that a slope of 1 is wide in the picture
local height = tonumber(robot.params.height)
local is_up = false

function init()
   if not height then
      local speed = tonumber(robot.params.speed)
      robot.leds.set_all_colors("red")
      robot.wheels.set_velocity(speed - 0.5, speed + 0.5)
      return
   end
   robot.colored_blob_perspective_camera.enable()
   robot.quadrotor.set_relative_position(0, 0, height)
end

-- The middle of all blobs: ahead and to the left of what is straight below [m].
local function seen()
   local blobs = robot.colored_blob_perspective_camera
   local ahead, left = 0, 0
   for _, blob in ipairs(blobs) do
      ahead = ahead + (240 - blob.y) / pixels * height / #blobs
      left = left + (320 - blob.x) / pixels * height / #blobs
   end
   return ahead, left
end

function step()
   if not height then return end
   is_up = is_up or robot.positioning.position.z > height - 0.1
   if is_up then
      local ahead, left = seen()
      robot.quadrotor.set_linear_velocity(ahead, left, 0)
   end
end
