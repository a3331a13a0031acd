-- A stigmergic block: its LEDs turn red when any of its radios receives a message.

function init() robot.directional_leds.set_all_colors("black") end

function step()
  for _, radio in pairs(robot.radios) do
    if #radio.rx_data > 0 then robot.directional_leds.set_all_colors("red") end
  end
end

function reset() init() end
