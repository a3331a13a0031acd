-- Paints where items are found and where they belong, and takes what was left at home.

local last_x

function init()
   world.floor.paint({x = 0.6, y = 0, width = 0.5, height = 1}, "gray60")
   world.floor.paint({x = -0.6, y = 0, radius = 0.3}, "black")
end

function post_step(tick)
   local item = world.entities.item
   if not item then return end
   local x = item.position.x
   if x < -0.2 and math.abs(x - last_x) < 1e-6 then
      world.metric("items", 1)
      world.remove(item)
      world.floor.paint({x = -0.6, y = 0, radius = 0.3}, "blue")
   end
   last_x = x
end
