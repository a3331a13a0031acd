-- SPDX-License-Identifier: MIT
-- Drives the four-wheeled vehicle of scenes/dynamics3d_multi_body_test.argos from your own Lua:
--
--   ziggurat serve scenes/dynamics3d_multi_body_test.argos &
--   lua5.3 vehicle.lua
local ziggurat = require "ziggurat"

local session = ziggurat.connect{endpoint = arg[1], name = "vehicle.lua"}
local vehicle = session.robots[1]

for tick, event in session.next do
   for _, joint in pairs(vehicle.joints) do
      if event ~= "step" then joint.set_target(1) end -- [rad/s]
   end
   if event == "step" then
      vehicle.log(("wheel velocity: %.2f"):format(vehicle.joints.base_wheel_fl.encoder))
   end
end
session:close()
print("the run has ended: " .. session.ending())
