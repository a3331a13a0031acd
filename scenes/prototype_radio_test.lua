-- Passes a token on: the other radio sends each number that one received, plus one (Listing 2.8).

function init()
   reset()
end

function step()
   if #robot.radios.radio_rx.rx_data > 0 then
      local token = robot.radios.radio_rx.rx_data[1][1]
      log("token " .. token)
      robot.radios.radio_tx.tx_data({token + 1})
      robot.leds.set_all_colors("red")
   else
      robot.leds.set_all_colors("black")
   end
end

function reset()
   if robot.id == "repeater0" then
      robot.radios.radio_tx.tx_data({0})
   end
end

function destroy()
end
