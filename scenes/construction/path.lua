-- Shortest ways around obstacles, on a grid (A*).

local path = {}

local cell = 0.04       -- m
local farthest = 45     -- cells from the start, in x and y

-- What a cell costs to cross: 1, more near an obstacle, much more within its radius. No cell is
-- forbidden, so there is a way from any place.
local function cost_at(x, y, obstacles)
  local cost = 1
  for _, obstacle in ipairs(obstacles) do
    local dx, dy = x - obstacle.x, y - obstacle.y
    local square = dx * dx + dy * dy
    if square < obstacle.soft * obstacle.soft then
      local distance = math.sqrt(square)
      if distance < obstacle.hard then
        cost = cost + 30 + 60 * (obstacle.hard - distance) / obstacle.hard
      else
        cost = cost + 4 * (obstacle.soft - distance) / (obstacle.soft - obstacle.hard)
      end
    end
  end
  return cost
end

-- A heap of {key, value}: the smallest value first.
local function push(heap, key, value)
  local i = #heap + 1
  while i > 1 do
    local parent = i // 2
    if heap[parent][2] <= value then break end
    heap[i] = heap[parent]
    i = parent
  end
  heap[i] = {key, value}
end

local function pop(heap)
  local top, last = heap[1], table.remove(heap)
  local size = #heap
  if size == 0 then return top[1] end
  local i = 1
  while true do
    local child = 2 * i
    if child > size then break end
    if child < size and heap[child + 1][2] < heap[child][2] then child = child + 1 end
    if heap[child][2] >= last[2] then break end
    heap[i] = heap[child]
    i = child
  end
  heap[i] = last
  return top[1]
end

local steps = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}, {1, 1}, {-1, 1}, {-1, -1}, {1, -1}}

-- Points {x, y} from near `from` to `to`, both {x, y} in one frame [m]. Obstacles are {x, y, hard,
-- soft}: radii within which the way should not and had better not lead. nil if it is too far.
function path.find(from, to, obstacles)
  local width = 4096
  local function key_of(i, j) return (i + 2048) * width + j + 2048 end
  local gi = math.floor((to.x - from.x) / cell + 0.5)
  local gj = math.floor((to.y - from.y) / cell + 0.5)
  local goal, start = key_of(gi, gj), key_of(0, 0)
  local function left_over(i, j)
    local a, b = math.abs(i - gi), math.abs(j - gj)
    return math.max(a, b) + 0.414 * math.min(a, b)
  end
  local known, before, costs, closed, heap = {[start] = 0}, {}, {}, {}, {}
  push(heap, start, left_over(0, 0))
  while #heap > 0 do
    local key = pop(heap)
    if key == goal then break end
    if not closed[key] then
      closed[key] = true
      local i, j = key // width - 2048, key % width - 2048
      for _, step in ipairs(steps) do
        local ni, nj = i + step[1], j + step[2]
        local next_key = key_of(ni, nj)
        if not closed[next_key] and math.max(math.abs(ni), math.abs(nj)) <= farthest then
          local cost = costs[next_key]
          if not cost then
            cost = cost_at(from.x + ni * cell, from.y + nj * cell, obstacles)
            costs[next_key] = cost
          end
          local length = step[1] ~= 0 and step[2] ~= 0 and 1.414 or 1
          local value = known[key] + cost * length
          if value < (known[next_key] or math.huge) then
            known[next_key], before[next_key] = value, key
            push(heap, next_key, value + left_over(ni, nj))
          end
        end
      end
    end
  end
  if not known[goal] then return nil end
  local points = {{x = to.x, y = to.y}}
  local key = before[goal]
  while key and key ~= start do
    local i, j = key // width - 2048, key % width - 2048
    table.insert(points, 1, {x = from.x + i * cell, y = from.y + j * cell})
    key = before[key]
  end
  return points
end

return path
