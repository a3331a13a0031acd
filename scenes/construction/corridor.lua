-- Who may work at the structure at the same time. A robot that places a block needs a corridor: the straight way
-- from where it lines up with a side to where it stands when it lets the block go. Robots whose corridors are
-- apart don't hinder each other. No robot can tell another its place, as they have no common frame; but each
-- sees from where another stands, and what row of the rule table it says, which place that may be.

local assembly = require "assembly"
local builder = require "builder"
local memory = require "memory"
local traffic = require "traffic"

local corridor = {}

local last_way = 0.17  -- straight way to the structure, for the steering to settle [m]
local apart = 0.25     -- of robots at work, between their centres
local reach = 0.45     -- farther away no robot can be lined up with a place
local same_row = 0.055 -- a robot that is less aside of a row of columns is lined up with it: they are 78 mm apart

-- From the robot's centre to a side when it lets the block go [m].
function corridor.distance_of(row) return builder.reach + (row.place == "above" and 0 or memory.pitch) end

-- Where to line up with a side {x, y, yaw (outward), row}.
function corridor.start_of(place)
  return assembly.ahead_of(place, corridor.distance_of(place.row) + last_way)
end

-- Whether a point is in the corridor to a side.
function corridor.has(place, point)
  local out, aside = assembly.seen_from(place, point)
  local near = corridor.distance_of(place.row)
  local beyond = out - math.max(near, math.min(near + last_way, out))
  return beyond ^ 2 + aside ^ 2 < apart ^ 2
end

local function anywhere(row) return row and row.place == "above" and not row.sides end

-- Whether a robot at that point, which wants to attach a block by a row of the table (nil if it does not say so),
-- may want to attach it where one is to come by this side.
function corridor.same_place(place, point, row)
  local out, aside = assembly.seen_from(place, point)
  local above = place.row.place == "above"
  out = out - (above and -0.5 * builder.block or memory.pitch - 0.5 * builder.block)
  if out ^ 2 + aside ^ 2 > reach ^ 2 then return false end
  if not row or anywhere(row) and anywhere(place.row) then return true end
  return not above and row.place == "before" and math.abs(out) < same_row
end

-- Whether another robot is at work in the row of columns that leads to a side or lined up with it, or is on its
-- way to a side and so much nearer than this one that it will be there first, or stands where that begins.
function corridor.is_taken(place, own_distance)
  local near = corridor.distance_of(place.row)
  local x, y = corridor.start_of(place)
  for _, other in ipairs(traffic.others) do
    local point = traffic.place_of(builder.pose, other)
    local out, aside = assembly.seen_from(place, point)
    local distance = math.sqrt((point.x - x) ^ 2 + (point.y - y) ^ 2)
    local in_row = aside < 0.2 and out > near - 0.05 and out < near + last_way + 0.2
    if in_row and (other.holding or other.asking and distance < own_distance) or
       distance < math.min(own_distance - 0.1, other.row > 0 and 0.5 or 0.25) then
      return true
    end
  end
  return false
end

-- Asks for the corridor to a side; call it in every step. True when the robot may enter.
function corridor.may_enter(place, rows)
  traffic.row = place.row.index
  return traffic.may_enter(
    function(other) return corridor.has(place, traffic.place_of(builder.pose, other)) end,
    function(other)
      return corridor.same_place(place, traffic.place_of(builder.pose, other), rows[other.row])
    end)
end

return corridor
