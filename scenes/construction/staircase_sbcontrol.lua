-- A stigmergic block that lights up in the colour that it receives: the first byte of a message to
-- any of its radios is 1 for red, 2 for green, 3 for blue. The script's parameter `color` is the
-- initial colour.

local colors = {"red", "green", "blue"}

function init() robot.directional_leds.set_all_colors(robot.params.color or "black") end

function step()
  for _, radio in pairs(robot.radios) do
    local message = radio.rx_data[1]
    if message and colors[message[1]] then
      robot.directional_leds.set_all_colors(colors[message[1]])
    end
  end
end

function reset() init() end
