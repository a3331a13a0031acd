-- Flashes once in a period. A robot that sees a flash begins its period anew, so that all flash together.

local period = 15  -- [ticks]
local phase, tick = 0, 0

function init()
   phase = tonumber(robot.params.phase)
   robot.colored_blob_omnidirectional_camera.enable()
end

function step()
   tick = tick + 1
   phase = (phase + 1) % period
   for _, blob in ipairs(robot.colored_blob_omnidirectional_camera) do
      if blob.color.red > 200 and blob.color.green == 0 then phase = 1 end
   end
   robot.leds.set_all_colors(phase == 0 and "red" or "black")
   if phase == 0 then log("flash ", tick) end
end
