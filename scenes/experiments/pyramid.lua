-- Scatters robots and blocks around the first block, which stays, and ends the run when the pyramid stands: a block
-- that lights up has been placed. Measures when the last one was, and how many stand where they should. Of a run
-- in which the pyramid is never complete, the time is that of its end.

local BLOCK, PITCH = 0.055, 0.078  -- edge of a block, distance of columns [m]
local LEAVE = 15                   -- for the robots to leave after the last block [s]

local places, complete_at

-- A point between two distances from the origin that is at least so far from all before [m].
local function scatter(nearest, farthest, apart)
  for _ = 1, 10000 do
    local angle, distance = world.random.uniform(0, 2 * math.pi), world.random.uniform(nearest, farthest)
    local point = {x = distance * math.cos(angle), y = distance * math.sin(angle), z = 0}
    local free = true
    for _, other in ipairs(places) do
      free = free and (point.x - other.x) ^ 2 + (point.y - other.y) ^ 2 > apart ^ 2
    end
    if free then
      places[#places + 1] = point
      return point
    end
  end
  error("there is no room for all robots and blocks; take fewer")
end

local function is_robot(entity) return entity.id:sub(1, 5) == "robot" end

-- Blocks first: they lie where they lie with any other number of robots.
function init()
  places, complete_at = {}, nil
  for _, robots in ipairs({false, true}) do
    for id, entity in pairs(world.entities) do
      if is_robot(entity) == robots and id ~= "block0" then
        local place = robots and scatter(0.95, 1.2, 0.3) or scatter(0.48, 0.95, 0.25)
        -- Places are apart from each other; one that moves later may still stand there.
        world.move(entity, place, {angle = world.random.uniform(0, 2 * math.pi), axis = {x = 0, y = 0, z = 1}},
                   {may_overlap = true})
      end
    end
  end
end

reset = init

local function is_lit(block)
  local color = block.directional_leds[1]
  return color.red + color.green + color.blue > 0
end

-- How many blocks have been placed, and of these the number of places that should have one and do.
local function count()
  local first = world.entities.block0
  local angle = first.orientation.angle * first.orientation.axis.z
  local c, s = math.cos(angle) / PITCH, math.sin(angle) / PITCH
  local lit, found, right = 0, {}, 0
  for _, block in pairs(world.entities) do
    if not is_robot(block) and is_lit(block) then
      lit = lit + 1
      local dx, dy = block.position.x - first.position.x, block.position.y - first.position.y
      local i, j = math.floor(c * dx + s * dy + 0.5), math.floor(c * dy - s * dx + 0.5)
      local level = math.floor((block.position.z - first.position.z) / BLOCK + 0.5)
      local key = i .. "," .. j .. "," .. level
      if level < 3 - math.abs(i) - math.abs(j) and not found[key] then right = right + 1 end
      found[key] = true
    end
  end
  return lit, right
end

function post_step()
  if world.tick % 10 ~= 0 then return end
  local lit, right = count()
  if lit == 15 then complete_at = complete_at or world.time end
  world.metric("time_to_finish", complete_at or world.time)
  world.metric("blocks_placed", lit)
  world.metric("blocks_right", right)
  if complete_at and world.time > complete_at + LEAVE then
    world.finish(string.format("%d of 15 blocks in their places after %.0f s", right, complete_at))
  end
end
