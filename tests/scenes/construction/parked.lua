-- Ends a run of robots that build when none of them has moved for 40 s, after the first minute. Robots that wait for
-- each other stand for up to 30 s.

local places, since

local function moved()
  local now, any = {}, false
  for id, entity in pairs(world.entities) do
    if id:sub(1, 5) == "robot" then
      local position, before = entity.position, places[id]
      local same = before and (position.x - before.x) ^ 2 + (position.y - before.y) ^ 2 < 0.001 ^ 2
      now[id] = same and before or position
      any = any or not same
    end
  end
  places = now
  return any
end

function init() places, since = {}, 0 end

reset = init

function post_step()
  if world.tick % 10 ~= 0 then return end
  if moved() or world.time < 60 then since = world.time end
  if world.time - since > 40 then world.finish("all robots stand") end
end
