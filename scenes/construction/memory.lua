-- What a robot remembers of what it saw, in a frame of its own: where the structure's columns are, what
-- their sides showed, where material lies. Columns stand on a square lattice; so every lit side that the
-- camera sees corrects the odometry.

local builder = require "builder"
local odometry = require "odometry"

local memory = {}

memory.pitch = 0.078   -- distance of columns [m]
memory.anchor = nil    -- the first column that was seen: {x, y, yaw}
memory.columns = {}    -- by "i,j": {i, j, x, y, sides}; sides[0 to 3] = {row or false, seen}
memory.material = {}   -- {x, y, yaw, seen}: dark blocks; yaw is a side's outward normal
memory.now = 0         -- ticks
memory.plan = nil      -- the rule table

-- A dark block nearer to a column than this is left alone: it is just being placed, or was dropped, and to
-- fetch it a robot would have to turn beside the structure [m].
local apart = 0.2

local last_lit = {}    -- the side that corrected the odometry last
local astray = 0       -- ticks in a row in which a lit side was seen where no column can be

-- A face in the robot's frame, in the frame of memory: centre of its block and outward normal.
local function block_of(face)
  local pose = builder.pose
  local heading = pose.yaw + face.heading
  local c, s = math.cos(pose.yaw), math.sin(pose.yaw)
  return {x = pose.x + c * face.forward - s * face.left + 0.5 * builder.block * math.cos(heading),
          y = pose.y + s * face.forward + c * face.left + 0.5 * builder.block * math.sin(heading),
          yaw = builder.wrapped(heading + math.pi)}
end

local function point_of(i, j)
  local anchor = memory.anchor
  local c, s = math.cos(anchor.yaw) * memory.pitch, math.sin(anchor.yaw) * memory.pitch
  return anchor.x + i * c - j * s, anchor.y + i * s + j * c
end

-- The lattice column nearest to a block, its side, and how far the block is off: {x, y, yaw}.
local function column_of(block)
  local anchor = memory.anchor
  local dx, dy = block.x - anchor.x, block.y - anchor.y
  local c, s = math.cos(anchor.yaw) / memory.pitch, math.sin(anchor.yaw) / memory.pitch
  local i = math.floor(c * dx + s * dy + 0.5)
  local j = math.floor(-s * dx + c * dy + 0.5)
  local quarters = (block.yaw - anchor.yaw) / (math.pi / 2)
  local x, y = point_of(i, j)
  local side = math.floor(quarters + 0.5)
  return i, j, side % 4,
         {x = block.x - x, y = block.y - y, yaw = (quarters - side) * math.pi / 2}
end

-- Shifts and turns the robot's pose so that a block that is off would be where it should.
local function correct(off, block)
  local pose = builder.pose
  local c, s = math.cos(-off.yaw), math.sin(-off.yaw)
  local dx, dy = pose.x - block.x, pose.y - block.y
  pose.x = block.x - off.x + c * dx - s * dy
  pose.y = block.y - off.y + s * dx + c * dy
  pose.yaw = pose.yaw - off.yaw
end

local function fits(off)
  return math.abs(off.yaw) < 0.35 and off.x * off.x + off.y * off.y < 0.035 ^ 2
end

-- Corrects the odometry by the nearest lit face; starts anew if that doesn't fit for a second.
local function find_oneself(face)
  local block = block_of(face)
  if not memory.anchor then
    memory.anchor = block
    return
  end
  local i, j, side, off = column_of(block)
  if fits(off) then
    astray = 0
    local key = i .. "," .. j .. "," .. side
    if last_lit.key == key and last_lit.seen == memory.now - 1 then
      odometry.learn(off.x, off.y)
    end
    last_lit = {key = key, seen = memory.now}
    correct(off, block)
  else
    astray = astray + 1
    if astray > 10 then
      log("lost: starts a new map")
      memory.anchor, memory.columns, astray = block, {}, 0
    end
  end
end

local directions = {[0] = {1, 0}, {0, 1}, {-1, 0}, {0, -1}}

local function beside(column, side)
  local to = directions[side]
  return memory.columns[column.i + to[1] .. "," .. column.j + to[2]]
end

local function column_at(i, j)
  local key = i .. "," .. j
  if not memory.columns[key] then
    local x, y = point_of(i, j)
    memory.columns[key] = {i = i, j = j, x = x, y = y, seen = memory.now, sides = {}}
  end
  return memory.columns[key]
end

-- What a column must show by the rule table, if its lowest block has this state and its front is that side.
local function expect(column, state, height, front)
  for side = 0, 3 do
    local row = memory.plan.row_for(state, height, (side - front) % 4, beside(column, side) ~= nil)
    column.sides[side] = {row = row or false, seen = memory.now, guessed = row and true}
  end
end

-- The robot has attached a block at a place {column, side, row}.
function memory.attached(place)
  local column, row = place.column, place.row
  if row.place == "above" then
    expect(column, row.state, row.height + 1, place.side)
  else
    local to = directions[place.side]
    local new = column_at(column.i + to[1], column.j + to[2])
    new.seen = memory.now
    column.sides[place.side] = {row = false, seen = memory.now}
    expect(new, row.becomes, 1, place.side)
  end
end

local function remember_side(face)
  local i, j, side, off = column_of(block_of(face))
  if not fits(off) then return end
  local column = column_at(i, j)
  for n = #memory.material, 1, -1 do
    local block = memory.material[n]
    if (block.x - column.x) ^ 2 + (block.y - column.y) ^ 2 < apart ^ 2 then
      table.remove(memory.material, n)
    end
  end
  column.seen = memory.now
  local row, before = memory.plan.row_shown(face.color), column.sides[side]
  if not row and before and before.row and before.row.place == "above" and before.row.sides then
    expect(column, before.row.state, before.row.height + 1, side)  -- somebody attached a block
  end
  column.sides[side] = {row = row or false, seen = memory.now}
end

local function remember_material(face)
  local block = block_of(face)
  if memory.anchor then
    for _, column in pairs(memory.columns) do
      if (block.x - column.x) ^ 2 + (block.y - column.y) ^ 2 < apart ^ 2 then return end
    end
  end
  block.seen = memory.now
  for n, known in ipairs(memory.material) do
    if (block.x - known.x) ^ 2 + (block.y - known.y) ^ 2 < 0.04 ^ 2 then
      if known.seen == memory.now - 1 then odometry.learn(block.x - known.x, block.y - known.y) end
      block.avoid = known.avoid
      memory.material[n] = block
      return
    end
  end
  memory.material[#memory.material + 1] = block
end

-- A point in the robot's frame: forward, left [m].
local function seen_from_robot(point)
  local pose = builder.pose
  local c, s = math.cos(pose.yaw), math.sin(pose.yaw)
  local dx, dy = point.x - pose.x, point.y - pose.y
  return c * dx + s * dy, -s * dx + c * dy
end

-- Whether something stands between the camera and a point in the robot's frame.
local function is_hidden(forward, left, others)
  for _, thing in ipairs(others) do
    if thing.forward > 0 and thing.forward < forward - 0.03 and
       math.abs(thing.left - left * thing.forward / forward) < thing.width then
      return true
    end
  end
  return false
end

-- Leaves dark blocks alone at which another robot is at work, and forgets those that have not been where they should be
-- in sight for a second: somebody took them.
local function forget_taken(robots)
  for _, robot in ipairs(robots) do
    for _, block in ipairs(memory.material) do
      local forward, left = seen_from_robot(block)
      if robot.working and not robot.holding and
         (forward - robot.forward) ^ 2 + (left - robot.left) ^ 2 < 0.15 ^ 2 then
        block.avoid = math.max(block.avoid or 0, memory.now + 300)
      end
    end
  end
  local others = {}
  for _, column in pairs(memory.columns) do
    local forward, left = seen_from_robot(column)
    others[#others + 1] = {forward = forward, left = left, width = 0.05}
  end
  for _, block in ipairs(memory.material) do
    local forward, left = seen_from_robot(block)
    others[#others + 1] = {forward = forward, left = left, width = 0.05}
  end
  for _, robot in ipairs(robots) do
    others[#others + 1] = {forward = robot.forward, left = robot.left, width = 0.17}
  end
  for n = #memory.material, 1, -1 do
    local block = memory.material[n]
    local forward, left = seen_from_robot(block)
    local in_sight = forward > 0.25 and forward < 0.65 and math.abs(left) < 0.3 * forward - 0.05 and
                     not is_hidden(forward, left, others)
    block.missed = in_sight and block.seen < memory.now and (block.missed or 0) + 1 or block.missed
    if (block.missed or 0) > 10 then table.remove(memory.material, n) end
  end
end

-- Takes in what the camera sees: faces as of builder.faces(). Nearer than 13 cm the LEDs are out
-- of the image. robots: the others, as of traffic.others.
function memory.update(faces, robots)
  memory.now = memory.now + 1
  local found_oneself = false
  for _, face in ipairs(faces) do
    if math.abs(face.up) < 0.02 and face.color and face.forward > 0.13 and face.forward < 0.95 then
      if not found_oneself then
        found_oneself = true
        find_oneself(face)
      end
      if math.abs(face.heading) < 1.1 then remember_side(face) end
    end
  end
  for _, face in ipairs(faces) do
    if math.abs(face.up) < 0.02 and not face.color and face.forward > 0.14 and face.forward < 0.8 then
      remember_material(face)
    end
  end
  forget_taken(robots)
end

-- Whether it still remembers a dark block there that is not to be left alone.
function memory.is_free(block)
  for _, known in ipairs(memory.material) do
    if (block.x - known.x) ^ 2 + (block.y - known.y) ^ 2 < 0.05 ^ 2 then return memory.now > (known.avoid or 0) end
  end
  return false
end

function memory.forget(block)
  for n, known in ipairs(memory.material) do
    if (block.x - known.x) ^ 2 + (block.y - known.y) ^ 2 < 0.05 ^ 2 then
      table.remove(memory.material, n)
      return
    end
  end
end

-- The middle of all known columns; nil if none is known.
function memory.middle()
  local x, y, count = 0, 0, 0
  for _, column in pairs(memory.columns) do x, y, count = x + column.x, y + column.y, count + 1 end
  if count == 0 then return memory.anchor end
  return {x = x / count, y = y / count}
end

-- The distance from the middle of the farthest column.
function memory.extent()
  local middle, most = memory.middle(), 0
  for _, column in pairs(memory.columns) do
    most = math.max(most, math.sqrt((column.x - middle.x) ^ 2 + (column.y - middle.y) ^ 2))
  end
  return most
end

-- What a column showed last that it shows on all of its sides: {row, seen}. What stands beside it tells it, too: it
-- has been attached by what the column showed.
local function shown_all_around(column)
  local latest
  for _, look in pairs(column.sides) do
    if look.row and not look.row.sides and (not latest or look.seen > latest.seen) then latest = look end
  end
  if not latest then return nil end
  for side = 0, 3 do
    local next_one = beside(column, side)
    for _, look in pairs(next_one and next_one.sides or {}) do
      local origin = look.row and memory.plan.origin_of(look.row, latest.row.state)
      if origin and not origin.sides and look.seen > latest.seen then latest = {row = origin, seen = look.seen} end
    end
  end
  return latest
end

-- Whether what a side showed is out of date: a column was seen before it since, or another side of its
-- column showed another row. latest: what the column showed last on all sides.
local function is_old(column, side, look, latest)
  local next_one = beside(column, side)
  if look.row.place == "before" and next_one and next_one.seen > look.seen then return true end
  if latest and latest.row ~= look.row and latest.seen > look.seen then return true end
  for _, other in pairs(column.sides) do
    if other.row and other.row ~= look.row and other.seen > look.seen + 50 then return true end
  end
  return false
end

-- What a side shows, as far as is known: {row, seen, guessed}; nil if nothing may be attached there. It is a guess
-- if another side was seen later.
local function look_at(column, side)
  local look, latest = column.sides[side], shown_all_around(column)
  if look and look.row and not is_old(column, side, look, latest) then return look end
  if latest and not beside(column, side) and (not look or look.row and look.row ~= latest.row) then
    return {row = latest.row, seen = latest.seen, guessed = true}
  end
end

-- All sides where something may be attached, seen in the last so many ticks: {column, side, row, seen, guessed, yaw
-- (outward), x, y (of the face)}.
function memory.open_sides(ticks)
  local open = {}
  for _, column in pairs(memory.columns) do
    for side = 0, 3 do
      local look = look_at(column, side)
      if look and memory.now - look.seen < (ticks or math.huge) then
        local yaw = memory.anchor.yaw + side * math.pi / 2
        open[#open + 1] = {column = column, side = side, row = look.row, yaw = yaw, seen = look.seen,
                           guessed = look.guessed,
                           x = column.x + 0.5 * builder.block * math.cos(yaw),
                           y = column.y + 0.5 * builder.block * math.sin(yaw)}
      end
    end
  end
  return open
end

-- As obstacles for path.find.
function memory.obstacles(list)
  for _, column in pairs(memory.columns) do
    list[#list + 1] = {x = column.x, y = column.y, hard = 0.185, soft = 0.26}
  end
  for _, block in ipairs(memory.material) do
    list[#list + 1] = {x = block.x, y = block.y, hard = 0.14, soft = 0.2}
  end
  return list
end

-- The seen face nearest to a place {x, y, yaw (outward)} of a block's side, within 4 cm; nil if none is.
function memory.seen_at(faces, place)
  local best, nearest = nil, 0.04
  for _, face in ipairs(faces) do
    if math.abs(face.up) < 0.02 then
      local block = block_of(face)
      local x = block.x + 0.5 * builder.block * math.cos(block.yaw)
      local y = block.y + 0.5 * builder.block * math.sin(block.yaw)
      local distance = math.sqrt((x - place.x) ^ 2 + (y - place.y) ^ 2)
      if distance < nearest and math.abs(builder.wrapped(block.yaw - place.yaw)) < 0.5 then
        best, nearest = face, distance
        face.place = {x = x, y = y, yaw = block.yaw}
      end
    end
  end
  return best
end

return memory
