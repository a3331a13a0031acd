-- Swings the arm at the speed of <params>, and logs the number of each step.

local steps = 0

function init()
   log("init")
   robot.joints.shoulder.set_target(tonumber(robot.params.speed))
end

function step()
   steps = steps + 1
   log("step ", steps)
   if steps == 10 then
      robot.joints.shoulder.set_target(-2 * robot.joints.shoulder.encoder)
   end
end

function destroy()
   log("destroy")
end
