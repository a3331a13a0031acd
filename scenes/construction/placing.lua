-- The states in which a robot places the block that it carries, where the structure's colours say.

local assembly = require "assembly"
local builder = require "builder"
local memory = require "memory"
local traffic = require "traffic"
local travel = require "travel"

local job = assembly.job
local before = builder.reach + memory.pitch  -- from the robot's centre to the side before which it places
local states = {}

local function distance_of(row) return row.place == "above" and builder.reach or before end

-- The side with the shortest free way of those that may get a block; nil if none is known.
local function nearest_side()
  local least, nearest
  for _, side in ipairs(memory.open_sides()) do
    local x, y = assembly.ahead_of(side, distance_of(side.row) + assembly.last_way)
    local cost = assembly.distance_to({x = x, y = y}) + assembly.hindrance(side, memory.material)
    if not least or cost < least then least, nearest = cost, side end
  end
  return nearest
end

function states.choose_side()
  job.after_scan = nil
  if not memory.middle() then return "wander" end
  job.tries, job.points = 0, {}
  return nearest_side() and "claim" or "survey"
end

-- Looks at the structure from all sides. When no side may get a block, it is complete.
function states.survey()
  if #memory.open_sides() > 0 then
    job.rounds = 0
    return "choose_side"
  end
  if #job.points == 0 then
    job.rounds = job.rounds + 1
    if job.rounds > 3 then return "park" end
    job.points = assembly.ring(assembly.survey_ring, 4)
  end
  if job.points[1].reached then
    local middle = memory.middle()
    if travel.turn_to(math.atan(middle.y - builder.pose.y, middle.x - builder.pose.x)) and job.seconds() > 2 then
      table.remove(job.points, 1)
      return "survey"
    end
  elseif assembly.go_to_ring(job.points[1]) or job.seconds() > 40 then
    job.points[1].reached = true
    return "survey"
  end
end

-- Waits outside until no other robot works at the structure.
function states.claim()
  if traffic.may_build() then
    job.place, job.tries = nearest_side(), 0  -- by what it has seen since
    if job.place then return "enter" end
    traffic.leave_structure()
    return "survey"
  end
  local middle = memory.middle()
  local ring_radius = assembly.waiting_ring + memory.extent()
  if assembly.distance_to(middle) < ring_radius - 0.05 then
    local angle = math.atan(builder.pose.y - middle.y, builder.pose.x - middle.x)
    travel.to(middle.x + ring_radius * math.cos(angle), middle.y + ring_radius * math.sin(angle))
  elseif travel.turn_to(math.atan(middle.y - builder.pose.y, middle.x - builder.pose.x)) then
    travel.wait()
  end
end

-- What the side shows does not count until it is seen again.
local function forget_color()
  local look = job.place.column and job.place.column.sides[job.place.side]
  if look then look.row = false end
end

local function give_up_side()
  traffic.leave_structure()
  forget_color()
  return "choose_side"
end

function states.enter()
  builder.lift_to(assembly.carrying + math.max(0, job.place.row.height - 1) * builder.block, 0.05)
  local x, y = assembly.ahead_of(job.place, distance_of(job.place.row) + assembly.last_way)
  local outcome = travel.to(x, y)
  if outcome == "there" then return "aim_at_side" end
  if outcome == "stuck" or job.seconds() > 60 then return give_up_side() end
end

-- What the side shows now counts, not what is remembered.
function states.aim_at_side(faces)
  local face = memory.seen_at(faces, job.place)
  if face then
    job.place.x, job.place.y, job.place.yaw = face.place.x, face.place.y, face.place.yaw
    local row = face.color and assembly.plan.row_shown(face.color)
    if row ~= job.place.row then return give_up_side() end
  end
  if travel.turn_to(math.atan(job.place.y - builder.pose.y, job.place.x - builder.pose.x)) then
    if face then return "attach" end
    if job.seconds() > 4 then return give_up_side() end
  end
  if job.seconds() > 20 then return give_up_side() end
end

function states.attach(faces)
  local face = memory.seen_at(faces, job.place)
  if face then job.place.x, job.place.y, job.place.yaw = face.place.x, face.place.y, face.place.yaw end
  if traffic.blocked(1) and job.seconds() < 30 then return builder.stop() end
  local above = job.place.row.place == "above"
  local arrived = builder.lift_to(assembly.carrying + (above and math.max(0, job.place.row.height - 1) or 0) *
                                  builder.block, 0.05)
  if above and not arrived then return builder.stop() end
  local now = assembly.face_of(job.place)
  local outcome = builder.dock_at(now, 0.05, above, distance_of(job.place.row))
  if outcome == "docked" and
     (math.abs(builder.offset(now)) > 0.001 or math.abs(now.heading) > 0.015) then
    outcome = "askew"
  end
  if outcome == "docked" then
    log("docked ", job.place.row.becomes, " ", 1000 * builder.offset(now), " mm ", math.deg(now.heading))
    return "place"
  end
  if outcome == "askew" or job.seconds() > 60 then return "retreat_from_side" end
end

function states.retreat_from_side()
  local may_try = job.retreat(3.3, 5)
  if may_try == false then return give_up_side() end
  return may_try and "enter" or nil
end

function states.place()
  -- The block remembers for the robot what it was at.
  robot.radios.nfc.tx_data({3, tonumber(job.payload), job.place.row.index})
  local height = job.place.row.place == "above" and job.place.row.height * builder.block or 0
  if builder.lift_to(math.max(0.0002, height - 0.0002), height > 0 and 0.01 or 0.02) then return "tell" end
end

-- Tells the block its state. From now on it tells the other robots what may be attached.
function states.tell()
  robot.radios.nfc.tx_data({1, job.place.row.number, tonumber(job.payload)})
  if job.seconds() >= 0.5 then return "release" end
end

function states.release()
  builder.current(math.max(-1, -2 * job.seconds()))
  if job.seconds() > 1.5 then return "rise" end
end

function states.rise()
  builder.loaded = false
  local height = job.place.row.place == "above" and job.place.row.height * builder.block or 0
  if builder.lift_to(math.min(0.14, height + 0.03), 0.03) then return "back_off" end
end

function states.back_off()
  if traffic.blocked(-1) and job.seconds() < 20 then return builder.stop() end
  builder.drive(-0.05, 0)
  if job.seconds() > 3.5 then
    forget_color()
    traffic.leave_structure()
    return job.place.column and "choose_block" or "scan"
  end
end

return states
