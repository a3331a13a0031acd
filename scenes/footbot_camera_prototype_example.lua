function init()
  reset()
end

function step()
  if (#robot.cameras.turret_camera.tag_detector > 0) or
     (#robot.cameras.turret_camera.directional_led_detector > 0) or
     (#robot.cameras.turret_camera.led_detector > 0) then
    local message = "turret_camera detects: "
    if (#robot.cameras.turret_camera.tag_detector > 0) then
      message = message .. "tags, "
    end
    if (#robot.cameras.turret_camera.directional_led_detector > 0) then
      message = message .. "directional_leds, "
    end
    if (#robot.cameras.turret_camera.led_detector > 0) then
      message = message .. "leds, "
    end
    log(message)
  end
end

function reset()
  robot.turret.set_speed_control_mode()
  robot.turret.set_rotation_speed(2)
  robot.wheels.set_velocity(0.25, -0.25)
end

function destroy()
end
