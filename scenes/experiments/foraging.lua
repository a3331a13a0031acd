-- Places food, takes away what a robot has reached, and places it anew somewhere else after a while.

local REACH = 0.25     -- a robot collects what is nearer to its centre [m]
local CLEAR = 0.5      -- food appears no nearer to a robot [m]
local HALF = 1.6       -- of the area where food appears [m]
local PAUSE = 20       -- ticks until something new appears

local goal = tonumber(world.params.goal)
local due = {}         -- ticks at which something new appears
local expected = {}    -- ids of what was placed last
local placed, collected = 0, 0

local function distance(a, b)
  return math.sqrt((a.x - b.x) ^ 2 + (a.y - b.y) ^ 2)
end

local function of_kind(kind, prefix)
  local found = {}
  for id, entity in pairs(world.entities) do
    if entity.kind == kind and id:find("^" .. prefix) then found[#found + 1] = entity end
  end
  return found
end

local function robots() return of_kind("foot-bot", "forager") end

-- Somewhere, but not beside a robot.
local function free_place()
  for _ = 1, 100 do
    local place = {x = world.random.uniform(-HALF, HALF), y = world.random.uniform(-HALF, HALF)}
    local is_free = true
    for _, robot in ipairs(robots()) do
      is_free = is_free and distance(robot.position, place) > CLEAR
    end
    if is_free then return place end
  end
end

local function place_item()
  local place = free_place()
  if not place then return false end
  placed = placed + 1
  local id = "food" .. placed
  world.spawn(string.format(
    '<cylinder id="%s" radius="0.05" height="0.1" movable="false"><body position="%.4f,%.4f,0"/></cylinder>',
    id, place.x, place.y))
  expected[#expected + 1] = id
  return true
end

local function begin()
  due, expected, placed, collected = {}, {}, 0, 0
  for i = 1, tonumber(world.params.items) do due[i] = 1 end
end

init = begin
reset = begin

function pre_step(tick)
  local later = {}
  for _, at in ipairs(due) do
    if at > tick or not place_item() then later[#later + 1] = at end
  end
  due = later
end

function post_step(tick)
  for _, id in ipairs(expected) do  -- what could not be placed, because something stands there
    if not world.entities[id] then due[#due + 1] = tick end
  end
  expected = {}
  local foragers = robots()
  for _, item in ipairs(of_kind("cylinder", "food")) do
    for _, robot in ipairs(foragers) do
      if distance(robot.position, item.position) < REACH then
        world.remove(item)
        due[#due + 1] = tick + PAUSE
        collected = collected + 1
        world.log(robot.id, " collects ", item.id, ": ", collected)
        break
      end
    end
  end
  world.metric("collected", collected)
end

function is_finished()
  return collected >= goal
end
