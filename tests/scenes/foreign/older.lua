-- Tells what is heard and seen of the others.
function init()
  robot.leds.set_all_colors("red")
  robot.colored_blob_omnidirectional_camera.enable()
  robot.range_and_bearing.set_data(1, 7)
end

function step()
  local red, yellow = 0, 0
  for _, blob in ipairs(robot.colored_blob_omnidirectional_camera) do
    if blob.color.green == 0 then red = red + 1 else yellow = yellow + 1 end
  end
  local heard = #robot.range_and_bearing > 0 and robot.range_and_bearing[1].data[1] or 0
  local light = 0
  for i = 1, #robot.light do light = light + robot.light[i].value end
  log("heard ", heard, " red ", red > 0, " yellow ", yellow, " light ", light > 0)
end

function reset() end
function destroy() end
