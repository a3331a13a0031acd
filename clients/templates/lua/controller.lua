-- Drives, and turns left while a sensor in front sees something near. Speeds are in cm/s.

local speed = tonumber(robot.params.speed)

function init()
   robot.leds.set_all_colors("green")
end

-- The greatest reading of the rays within 60 degrees of straight ahead: 0 is nothing, 1 is contact.
local function ahead()
   local greatest = 0
   for _, ray in ipairs(robot.proximity) do
      if math.abs(ray.angle) < math.rad(60) then greatest = math.max(greatest, ray.value) end
   end
   return greatest
end

function step()
   local is_near = ahead() > 0
   robot.wheels.set_velocity(is_near and -speed / 2 or speed, is_near and speed / 2 or speed)
   robot.leds.set_all_colors(is_near and "red" or "green")
end

function reset()
   init()
end

function destroy() end
