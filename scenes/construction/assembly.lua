-- What the states of assembler.lua share: what the robot is at, dimensions, geometry.

local builder = require "builder"
local memory = require "memory"
local rules = require "rules"
local traffic = require "traffic"
local travel = require "travel"

local assembly = {}

assembly.plan = rules.load(robot.params.rules)
memory.plan = assembly.plan

assembly.clearance = 0.03     -- lift, without a block [m]
assembly.carrying = 0.075     -- lift, with a block, out of the camera's sight
assembly.run_up = 0.13        -- straight way to a dark block, for the steering to settle
assembly.waiting_ring = 0.55  -- distance from the structure's outermost column where robots wait
assembly.survey_ring = 0.42   -- from where they look at it
assembly.search_ring = 0.55   -- from where they look for material
assembly.parking_ring = 0.85  -- where they stay when it is complete

-- state, since: the present state and its age in ticks
-- target:       the material block that it fetches, one of its sides: {x, y, yaw (outward), block}
-- place:        the side at which it attaches: {x, y, yaw (outward), row, column, side}
-- looked:       when it saw that side last
-- payload:      number on the side of the carried block that looks at the robot
-- after_scan:   the state after looking around
-- points:       places still to look from
-- wander_to:    where to look for the structure next
-- rounds:       how often it looked from everywhere in vain
-- tries:        how often it approached one side
local job = {state = "start", since = 0, points = {}, rounds = 0, tries = 0}
assembly.job = job

function job.seconds() return job.since * builder.tick end

-- Drives back for some seconds. Then: whether it may try again, which it may so often.
function job.retreat(seconds, most)
  if traffic.blocked(-1) and job.seconds() < 15 then
    builder.stop()
    return nil
  end
  builder.drive(-0.05, 0)
  if job.seconds() <= seconds then return nil end
  job.tries = job.tries + 1
  return job.tries <= most
end

-- Where a free robot and one with a block begin.
function assembly.decide() return builder.loaded and "choose_side" or "choose_block" end

function assembly.distance_to(thing)
  return math.sqrt((thing.x - builder.pose.x) ^ 2 + (thing.y - builder.pose.y) ^ 2)
end

function assembly.from_middle(thing)
  local middle = memory.middle()
  return math.sqrt((thing.x - middle.x) ^ 2 + (thing.y - middle.y) ^ 2)
end

-- The point in front of a side {x, y, yaw (outward)}.
function assembly.ahead_of(thing, distance)
  return thing.x + distance * math.cos(thing.yaw), thing.y + distance * math.sin(thing.yaw)
end

-- A point {x, y} seen from a side: how far out, and aside of the line through its middle.
function assembly.seen_from(thing, point)
  local c, s = math.cos(thing.yaw), math.sin(thing.yaw)
  local dx, dy = point.x - thing.x, point.y - thing.y
  return c * dx + s * dy, math.abs(c * dy - s * dx)
end

-- A side, as a face in the robot's frame.
function assembly.face_of(thing)
  local pose = builder.pose
  local c, s = math.cos(pose.yaw), math.sin(pose.yaw)
  local dx, dy = thing.x - pose.x, thing.y - pose.y
  return {forward = c * dx + s * dy, left = -s * dx + c * dy,
          heading = builder.wrapped(thing.yaw + math.pi - pose.yaw)}
end

-- Whether another robot is within reach of a place and nearer to it than this one.
function assembly.taken(thing, reach)
  for _, other in ipairs(traffic.others) do
    local point = traffic.place_of(builder.pose, other)
    local distance = math.sqrt((point.x - thing.x) ^ 2 + (point.y - thing.y) ^ 2)
    if distance < reach and distance < assembly.distance_to(thing) then return true end
  end
  return false
end

-- What the obstacles on the straight way to a side are worth in metres of another way.
function assembly.hindrance(thing, obstacles)
  local sum = 0
  for _, obstacle in ipairs(obstacles) do
    local out, aside = assembly.seen_from(thing, obstacle)
    if out > 0.04 and out < 0.42 and aside < 0.14 then sum = sum + 1 end
  end
  return sum
end

-- Points around the structure, the nearest first and then in one direction.
function assembly.ring(radius, count)
  local middle = memory.middle()
  local start = math.atan(builder.pose.y - middle.y, builder.pose.x - middle.x)
  local sign = robot.random.bernoulli() == 1 and 1 or -1
  local list = {}
  for n = 1, count do
    local angle = start + sign * (n - 1) * 2 * math.pi / count
    list[n] = {angle = angle, radius = radius + memory.extent()}
  end
  return list
end

function assembly.go_to_ring(point)
  local middle = memory.middle()
  return travel.to(middle.x + point.radius * math.cos(point.angle),
                   middle.y + point.radius * math.sin(point.angle))
end

return assembly
