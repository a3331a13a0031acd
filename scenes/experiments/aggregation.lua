-- Ends the run when all robots are within a radius of their centre, and measures when that was. Of a run in which
-- they never are, the time is that of its end.

local radius = tonumber(world.params.radius)
local spread = math.huge

-- The distance of the robot that is farthest from the centre of all [m].
local function farthest()
  local x, y, count = 0, 0, 0
  local positions = {}
  for _, entity in pairs(world.entities) do
    if entity.controller ~= "" then
      local position = entity.position
      x, y, count = x + position.x, y + position.y, count + 1
      positions[count] = position
    end
  end
  local most = 0
  for _, position in ipairs(positions) do
    local dx, dy = position.x - x / count, position.y - y / count
    most = math.max(most, math.sqrt(dx * dx + dy * dy))
  end
  return most
end

function post_step()
  spread = farthest()
  world.metric("spread", spread)
  world.metric("time_to_aggregate", world.time)
end

function is_finished()
  return spread < radius
end
