-- Ends the run when one of the blocks stands on the other and the robot has left it, and reports how far the upper
-- block is aside of the lower one and how much it is turned. In the scene of judge.py:
--   ziggurat run clients/python/examples/judge.argos --set director/@command= \
--       --set director/@script=../../../scenes/experiments/judge.lua

local SIDE = 0.055    -- of a block [m]
local STILL = 0.0005  -- what a block that stands moves at most [m]
local AWAY = 0.15     -- the robot from the stack, in the plane [m]

local rest = tonumber(world.params.rest) - 1e-9  -- how long it must stand, but for rounding [s]
local since, place                               -- since when the upper block stands there

-- In the plane [m].
local function distance(a, b)
  return math.sqrt((a.x - b.x) ^ 2 + (a.y - b.y) ^ 2)
end

-- The direction of the x axis of a block in the plane [degrees].
local function heading(block)
  local angle, axis = block.orientation.angle, block.orientation.axis
  local cos, sin = math.cos(angle), math.sin(angle)
  return math.deg(math.atan(axis.x * axis.y * (1 - cos) + axis.z * sin, cos + axis.x ^ 2 * (1 - cos)))
end

-- Up to quarter turns [degrees].
local function turn_between(lower, upper)
  return math.abs((heading(upper) - heading(lower) + 45) % 90 - 45)
end

local function stands(lower, upper, robot)
  local height = upper.position.z - lower.position.z
  return math.abs(height - SIDE) < 0.1 * SIDE and distance(lower.position, upper.position) < SIDE / 2
    and distance(robot.position, upper.position) > AWAY
end

function init() place = nil end

reset = init

function post_step()
  local lower, upper = world.entities.block1, world.entities.block2
  if lower.position.z > upper.position.z then lower, upper = upper, lower end
  if not stands(lower, upper, world.entities.robot0) then
    place = nil
    return
  end
  if not place or distance(place, upper.position) > STILL then since, place = world.time, upper.position end
  if world.time - since < rest then return end
  local aside = 1000 * distance(lower.position, upper.position)
  world.metric("aside_mm", aside)
  world.metric("turned_deg", turn_between(lower, upper))
  world.finish(string.format("%s stands on %s, %.1f mm aside", upper.id, lower.id, aside))
end
