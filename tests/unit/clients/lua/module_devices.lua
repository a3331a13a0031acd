-- scenes/devices_test.lua once more, for both robots in one Lua state: module_devices.lua ENDPOINT
local ziggurat = require "ziggurat"
local session = ziggurat.connect{endpoint = arg[1], robots = {"*"}, wait_timeout = 20}
assert(#session.robots == 2)
local tower, watcher = session.robots.tower, session.robots.watcher
assert(tower == session.robots[1] and watcher == session.robots[2])
assert(tower.id == "tower" and session.tick_length > 0 and session.seed > 0)
assert(not session.ending())

local posts, at_post, heard = 0, false, -1

local function turn()
   local sees = tower.proximity[1] > 0
   if sees and not at_post then
      posts = posts + 1
      tower.tags.set_all_payloads("posts: " .. posts)
      tower.range_and_bearing.set_data(1, posts)
      tower.log(string.format("post %d at %.2f rad, reading %.3f, by data sheet %.0f", posts,
                              tower.joints.neck.encoder, tower.proximity[1], tower.proximity[2]))
   end
   tower.directional_leds.set_all_colors(sees and "green" or "red")
   at_post = sees
end

local function watch()
   for _, packet in ipairs(watcher.range_and_bearing) do
      if packet.data[1] ~= heard then
         heard = packet.data[1]
         watcher.log(string.format("heard %d from %.1f cm away, bearing %.3f rad", heard,
                                   packet.range, packet.horizontal_bearing))
      end
   end
end

local last
for tick, event in session.next do
   assert(tick == (last and last + 1 or 0))
   assert(event == (tick == 0 and "init" or "step"))
   last = tick
   if event == "init" then tower.joints.neck.set_target(1) end
   if event == "step" then turn() watch() end
end
local reason, message, tick = session.ending()
assert(reason == "finished" and message == "" and tick == last)
assert(session:next() == nil)
session:close()
session:close()
