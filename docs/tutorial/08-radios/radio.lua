local radius = 0.03  -- [m]
local tick = 0

local function drive(speed)  -- [m/s]
  for _, wheel in pairs(robot.joints) do wheel.set_target(speed / radius) end
end

function init() end

function step()
  tick = tick + 1
  if robot.id == "first" and tick == 100 then  -- after two seconds
    drive(0.2)
    robot.radios.radio.tx_data({1})
  end
  for _, message in ipairs(robot.radios.radio.rx_data) do
    log("heard ", message[1])
    drive(0.2)
  end
end
