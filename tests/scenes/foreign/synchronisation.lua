PERIOD = 30

function init()
  reset()
end

function reset()
  phase = robot.random.uniform_int(0, PERIOD)
  robot.colored_blob_omnidirectional_camera.enable()
  robot.leds.set_all_colors("black")
end

function step()
  phase = phase + 1
  local seen = #robot.colored_blob_omnidirectional_camera
  if seen > 0 and phase < PERIOD then
    phase = phase + 0.15 * phase
  end
  if phase >= PERIOD then
    phase = 0
    robot.leds.set_all_colors(255, 0, 0)
    log("flash ", seen)
  else
    robot.leds.set_all_colors("black")
  end
end

function destroy()
end
