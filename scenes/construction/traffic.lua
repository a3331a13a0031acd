-- How robots keep clear of each other. Each tells the others within 2 m by radio what it does; the
-- radio also measures their distances and directions. None knows another's plan.

local builder = require "builder"

local traffic = {}

traffic.others = {}      -- {forward, left, range, working, asking, holding, claim} of robots in range
traffic.working = false  -- it picks up or places a block: the others keep out of its way
traffic.asking = false   -- it wants to work at the structure
traffic.holding = false  -- it works there; others stay away from it

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
      working = flags % 2 == 1, asking = flags // 2 % 2 == 1, holding = flags // 4 == 1,
      claim = packet.data[2]}
  end
  unchanged = now
end

-- Tells the others; call it last in every step.
function traffic.tell()
  local flags = (traffic.working and 1 or 0) + (traffic.asking and 2 or 0) +
                (traffic.holding and 4 or 0)
  robot.range_and_bearing.set_data({flags, claim, robot.random.uniform_int(256)})
end

-- Asks for the structure; call it in every step. True when this robot may go there: for half a second
-- no robot has been there, and none with a greater claim has asked.
function traffic.may_build()
  if not traffic.asking then
    traffic.asking, asked, claim = true, 0, robot.random.uniform_int(1, 256)
  end
  asked = asked + 1
  for _, other in ipairs(traffic.others) do
    if other.holding or (other.asking and other.claim >= claim) then
      asked = 0
      if other.claim == claim then traffic.asking = false end  -- a draw: another claim
      return false
    end
  end
  if asked < 5 then return false end
  traffic.asking, traffic.holding = false, true
  return true
end

function traffic.leave_structure() traffic.asking, traffic.holding = false, false end

-- The robot that is in the way of a motion with this sign (1 forward, -1 backward); nil if none is.
-- Robots reach 14 cm around their centres, this one's front is 6 cm wide around the arm.
function traffic.blocked(direction)
  local front = direction > 0 and 0.10 or -0.03
  for _, other in ipairs(traffic.others) do
    if other.forward * direction > 0 and
       (other.forward - front) ^ 2 + other.left ^ 2 < 0.245 ^ 2 then
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

-- As obstacles for path.find, in the frame of the pose.
function traffic.obstacles(pose, list)
  local c, s = math.cos(pose.yaw), math.sin(pose.yaw)
  for _, other in ipairs(traffic.others) do
    list[#list + 1] = {x = pose.x + c * other.forward - s * other.left,
                       y = pose.y + s * other.forward + c * other.left,
                       hard = other.working and 0.36 or 0.3, soft = 0.48}
  end
  return list
end

return traffic
