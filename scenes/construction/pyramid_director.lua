-- Ends the run when the pyramid stands: each of the fifteen places around the first block has a block, none of them has
-- moved for a while, and all robots have left. It only looks: robots and blocks know nothing of it.

local BLOCK, PITCH = 0.055, 0.078  -- edge of a block, distance of columns [m]
local NEAR = 0.01                  -- of a block in its place, aside and in height [m]
local STILL = 0.0005               -- that a block that stands moves at most [m]
local AWAY = 0.15                  -- of a robot from all blocks of the pyramid, in the plane [m]
local PLACES = 15

local rest = tonumber(world.params.rest) - 1e-9  -- how long it must stand, but for rounding [s]
local stood, since                               -- positions of the blocks in their places, and since when

local function is_robot(entity) return entity.id:sub(1, 5) == "robot" end

-- The place of a block in columns and levels from the first one, and how far it is from there [m].
local function place_of(position, first, angle)
  local dx, dy = position.x - first.x, position.y - first.y
  local x, y = math.cos(angle) * dx + math.sin(angle) * dy, math.cos(angle) * dy - math.sin(angle) * dx
  local i, j = math.floor(x / PITCH + 0.5), math.floor(y / PITCH + 0.5)
  local height = position.z - first.z
  local level = math.floor(height / BLOCK + 0.5)
  local aside = math.sqrt((x - i * PITCH) ^ 2 + (y - j * PITCH) ^ 2)
  return i, j, level, math.max(aside, math.abs(height - level * BLOCK))
end

-- Blocks in their places: positions by id, how many there are, and the farthest from its place [m].
local function look()
  local first = world.entities.block0
  local found, count, worst = {}, 0, 0
  for id, entity in pairs(world.entities) do
    if not is_robot(entity) then
      local i, j, level, off = place_of(entity.position, first.position, first.orientation.yaw)
      local column = math.max(math.abs(i), math.abs(j)) <= 1
      if column and level >= 0 and level < 3 - math.abs(i) - math.abs(j) and off < NEAR then
        found[id], count, worst = entity.position, count + 1, math.max(worst, off)
      end
    end
  end
  return found, count, worst
end

local function has_moved(found)
  for id, at in pairs(found) do
    local before = stood[id]
    if not before then return true end
    if (at.x - before.x) ^ 2 + (at.y - before.y) ^ 2 + (at.z - before.z) ^ 2 > STILL ^ 2 then return true end
  end
  return false
end

local function robots_have_left(found)
  for _, entity in pairs(world.entities) do
    for _, at in pairs(is_robot(entity) and found or {}) do
      local robot = entity.position
      if (robot.x - at.x) ^ 2 + (robot.y - at.y) ^ 2 < AWAY ^ 2 then return false end
    end
  end
  return true
end

function init() stood, since = {}, 0 end

reset = init

function post_step()
  if world.tick % 10 ~= 0 then return end
  local found, count, worst = look()
  world.metric("blocks_in_place", count)
  if count < PLACES or has_moved(found) or not robots_have_left(found) then
    stood, since = found, world.time
    return
  end
  if world.time - since < rest then return end
  world.metric("worst_mm", 1000 * worst)
  world.finish(string.format("the pyramid stands after %.0f s, no block more than %.1f mm off", since, 1000 * worst))
end
