-- The tower rotates, lights its LEDs at every post and counts the posts; the watcher receives.

local posts, at_post, heard

function init()
   reset()
end

function turn()
   local sees = robot.proximity[1] > 0
   if sees and not at_post then
      posts = posts + 1
      robot.tags.set_all_payloads("posts: " .. posts)
      robot.range_and_bearing.set_data(1, posts)
      log(string.format("post %d at %.2f rad, reading %.3f, by data sheet %.0f", posts,
                        robot.joints.neck.encoder, robot.proximity[1], robot.proximity[2]))
   end
   if sees then
      robot.directional_leds.set_all_colors("green")
   else
      robot.directional_leds.set_all_colors("red")
   end
   at_post = sees
end

function watch()
   for _, packet in ipairs(robot.range_and_bearing) do
      if packet.data[1] ~= heard then
         heard = packet.data[1]
         log(string.format("heard %d from %.1f cm away, bearing %.3f rad", heard, packet.range,
                           packet.horizontal_bearing))
      end
   end
end

function step()
   if robot.id == "tower" then turn() else watch() end
end

function reset()
   posts, at_post, heard = 0, false, -1
   if robot.id == "tower" then robot.joints.neck.set_target(1) end
end

function destroy()
end
