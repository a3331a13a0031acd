-- How robots keep clear of each other. Each tells the others within 2 m by radio what it does; the
-- radio also measures their distances and directions. None knows another's plan.

local builder = require "builder"

local traffic = {}

traffic.others = {}      -- {forward, left, range, working, asking, holding, stopped, row, claim} of robots in range
traffic.working = false  -- it picks up or places a block: the others keep out of its way
traffic.asking = false   -- it is lined up with a side of the structure and wants to go there
traffic.holding = false  -- it works there
traffic.stopped = false  -- another robot is in its way
traffic.row = 0          -- the row of the rule table by which it wants to attach a block; 0 if it does not know

local claim, asked = 1, 0 -- of two that ask, the one with the greater claim may; ticks since it asked

-- A robot whose controller has died goes on sending its last bytes: the third is random at each tick.
local unchanged = {}      -- ticks for which the same bytes have come, by the bytes
local dead = 50           -- after so many it counts as an obstacle only

-- Reads what the others say; call it first in every step.
function traffic.sense()
  traffic.others = {}
  local now = {}
  for i, packet in ipairs(robot.range_and_bearing) do
    local range, bearing, flags = packet.range / 100, packet.horizontal_bearing, packet.data[1]
    local bytes = table.concat(packet.data, ",")
    now[bytes] = (unchanged[bytes] or 0) + 1
    if now[bytes] > dead then flags = 0 end
    traffic.others[i] = {
      forward = range * math.cos(bearing), left = range * math.sin(bearing), range = range,
      working = flags % 2 == 1, asking = flags // 2 % 2 == 1, holding = flags // 4 % 2 == 1,
      stopped = flags // 8 % 2 == 1, row = flags // 16, claim = packet.data[2]}
  end
  unchanged = now
end

-- Tells the others; call it last in every step.
function traffic.tell()
  local flags = (traffic.working and 1 or 0) + (traffic.asking and 2 or 0) +
                (traffic.holding and 4 or 0) + (traffic.stopped and 8 or 0) + 16 * traffic.row
  robot.range_and_bearing.set_data({flags, claim, robot.random.uniform_int(256)})
end

-- Asks for a corridor to the structure; call it in every step. in_the_way(other) says of another robot whether
-- it is there, is_rival(other) whether it might get into the way from where it is. True when this robot may go:
-- for half a second no rival has held or asked with a greater claim.
function traffic.may_enter(in_the_way, is_rival)
  if not traffic.asking then
    traffic.asking, asked, claim = true, 0, robot.random.uniform_int(1, 256)
  end
  asked = asked + 1
  for _, other in ipairs(traffic.others) do
    local rival = other.holding or (other.asking and other.claim >= claim)
    if in_the_way(other) and (rival or not other.asking) or rival and is_rival(other) then
      asked = 0
      if other.claim == claim then traffic.asking = false end  -- a draw: another claim
      return false
    end
  end
  if asked < 5 then return false end
  traffic.asking, traffic.holding = false, true
  return true
end

function traffic.leave_structure() traffic.asking, traffic.holding, traffic.row = false, false, 0 end

-- The robot that is in the way of a motion with this sign (1 forward, -1 backward); nil if none is.
-- Robots reach 14 cm around their centres, this one's front is 6 cm wide around the arm.
function traffic.blocked(direction, reach)
  local front = direction > 0 and 0.10 or -0.03
  reach = reach or 0.245
  for _, other in ipairs(traffic.others) do
    if other.forward * direction > 0 and
       (other.forward - front) ^ 2 + other.left ^ 2 < reach ^ 2 then
      return other
    end
  end
end

-- The nearest robot.
function traffic.nearest()
  local nearest
  for _, other in ipairs(traffic.others) do
    if not nearest or other.range < nearest.range then nearest = other end
  end
  return nearest
end

-- Where another robot stands, in the frame of the pose.
function traffic.place_of(pose, other)
  local c, s = math.cos(pose.yaw), math.sin(pose.yaw)
  return {x = pose.x + c * other.forward - s * other.left, y = pose.y + s * other.forward + c * other.left}
end

-- As obstacles for path.find, in the frame of the pose. Those that are far away and not at work will be somewhere else
-- when this robot comes there.
function traffic.obstacles(pose, list)
  for _, other in ipairs(traffic.others) do
    if other.working or other.range < 0.7 then
      local point = traffic.place_of(pose, other)
      point.hard, point.soft = other.working and 0.36 or 0.3, 0.48
      list[#list + 1] = point
    end
  end
  return list
end

return traffic
