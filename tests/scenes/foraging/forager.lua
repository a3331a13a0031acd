-- Drives ahead until its gripper holds something, then backward until the floor below it is black.

local state, speed = "search", 8  -- [cm/s]
local tick, grey_at = 0, nil

function init()
   robot.gripper.lock_positive()
end

local function is_home()
   for _, sensor in ipairs(robot.base_ground) do
      if sensor.value == 1 then return false end
   end
   return true
end

function step()
   tick = tick + 1
   local brightness = robot.motor_ground[1].value
   if not grey_at and brightness > 0.4 and brightness < 0.7 then
      grey_at = tick
      log("grey at tick ", tick)
   end
   if state == "search" and robot.gripper.gripped == 1 then
      state = "return"
      robot.leds.set_all_colors("green")
      log("gripped at tick ", tick)
   elseif state == "return" and is_home() then
      state = "home"
      robot.gripper.unlock()
      robot.leds.set_all_colors("black")
      log("home at tick ", tick)
   elseif state == "home" and robot.gripper.gripped == 0 then
      state = "done"
      log("released at tick ", tick)
   end
   local way = state == "search" and 1 or state == "return" and -1 or 0
   robot.wheels.set_velocity(way * speed, way * speed)
end
