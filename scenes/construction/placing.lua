-- The states in which a robot places the block that it carries, where the structure's colours say.

local assembly = require "assembly"
local builder = require "builder"
local corridor = require "corridor"
local memory = require "memory"
local odometry = require "odometry"
local traffic = require "traffic"
local travel = require "travel"

local job = assembly.job
local states = {}

-- The side with the shortest free way of those that may get a block; nil if none is known, or other robots
-- are at work at each that is. What was seen long ago is less certain.
local function nearest_side()
  local least, nearest
  for _, side in ipairs(memory.open_sides()) do
    local x, y = corridor.start_of(side)
    local distance = assembly.distance_to({x = x, y = y})
    if not corridor.is_taken(side, distance) then
      local cost = distance + assembly.hindrance(side, memory.material) +
                   math.min(1, 1e-3 * (memory.now - side.seen)) + (side.guessed and 0.2 or 0)
      if not least or cost < least then least, nearest = cost, side end
    end
  end
  return nearest
end

function states.choose_side()
  job.after_scan = nil
  if not memory.middle() then return "wander" end
  job.tries = 0
  job.place = nearest_side()
  if job.place then
    job.points = {}
    return "enter"
  end
  return #memory.open_sides() > 0 and "queue" or "survey"
end

-- Looks at the structure from all sides. When no side may get a block, it is complete.
function states.survey()
  if nearest_side() then
    job.rounds = 0
    return "choose_side"
  end
  if #job.points == 0 then
    if #memory.open_sides() > 0 then return "queue" end
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

-- Waits outside while others are at work at all sides that may get a block, then looks from elsewhere.
function states.queue()
  if job.since % 5 == 0 and nearest_side() then return "choose_side" end
  if job.seconds() > 6 then
    job.points = assembly.ring(assembly.survey_ring, 4)
    return "survey"
  end
  local middle = memory.middle()
  local radius = assembly.waiting_ring + memory.extent()
  local x, y = builder.pose.x - middle.x, builder.pose.y - middle.y
  local distance = math.sqrt(x * x + y * y)
  if math.abs(distance - radius) > 0.1 then
    travel.to(middle.x + radius / distance * x, middle.y + radius / distance * y)
  elseif travel.turn_to(math.atan(-y, -x)) then
    travel.wait()
  end
end

-- What the side shows does not count until it is seen again.
local function forget_color()
  if not job.place.column then return end
  job.place.column.sides[job.place.side] = {row = false, seen = memory.now}
end

local function give_up_side()
  traffic.leave_structure()
  forget_color()
  return "choose_side"
end

-- Height of the lift on the way to the side; while it lines up, also if the colour changes.
local function height_for(row)
  return assembly.carrying + (row.place == "above" and row.height - 1 or 0) * builder.block
end

-- To where the straight way to the side begins.
function states.enter()
  traffic.row = job.place.row.index
  builder.lift_to(height_for(job.place.row), 0.05)
  local x, y = corridor.start_of(job.place)
  local distance = assembly.distance_to({x = x, y = y})
  if not traffic.holding and distance < 0.7 and corridor.is_taken(job.place, distance) then
    traffic.leave_structure()
    return "choose_side"
  end
  local outcome = travel.to(x, y)
  if outcome == "there" then
    job.looked = memory.now
    return "claim"
  end
  if outcome == "occupied" and not traffic.holding then
    traffic.leave_structure()
    return "queue"
  end
  if outcome == "stuck" or job.seconds() > 60 then return give_up_side() end
end

-- What the side shows: its place becomes where the camera sees it. False if it is not in sight, otherwise the
-- row, or nil if nothing may be attached there. Nearer than 13 cm the LEDs are out of the image.
local function look(faces)
  local face = memory.seen_at(faces, job.place)
  if not face then return false end
  job.place.x, job.place.y, job.place.yaw = face.place.x, face.place.y, face.place.yaw
  if face.forward < 0.15 then return job.place.row end
  return face.color and assembly.plan.row_shown(face.color)
end

-- Before the side, until the corridor to it is free. What the side shows now counts, not what is remembered.
function states.claim(faces)
  local row = look(faces)
  if row == nil then return give_up_side() end
  if row then job.place.row, job.looked = row, memory.now end
  builder.lift_to(height_for(job.place.row), 0.05)
  local x, y = corridor.start_of(job.place)
  if assembly.distance_to({x = x, y = y}) > 0.13 then
    traffic.asking = false
    return "enter"
  end
  local turned = travel.turn_to(math.atan(job.place.y - builder.pose.y, job.place.x - builder.pose.x))
  if turned and memory.now - job.looked > 8 or job.seconds() > 60 then return give_up_side() end
  if turned and row and (traffic.holding or corridor.may_enter(job.place, assembly.plan.rows)) then
    return "attach"
  end
end

function states.attach(faces)
  local row = look(faces)
  if row ~= false and row ~= job.place.row then
    job.tries = math.huge
    return "retreat_from_side"
  end
  if traffic.blocked(1, 0.19) and job.seconds() < 30 then return builder.stop() end
  local above = job.place.row.place == "above"
  local arrived = builder.lift_to(height_for(job.place.row), 0.05)
  if above and not arrived then return builder.stop() end
  local now = assembly.face_of(job.place)
  local outcome = builder.dock_at(now, 0.05, above, corridor.distance_of(job.place.row), odometry.ahead())
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

-- From the lift's height when the block stands.
local function height_of_place()
  return job.place.row.place == "above" and job.place.row.height * builder.block or 0
end

-- The last 2 cm slowly: the magnets of what stands below pull.
function states.place()
  -- The block remembers for the robot what it was at.
  robot.radios.nfc.tx_data({3, tonumber(job.payload), job.place.row.index})
  local height = height_of_place()
  local slow = height > 0 and 0.01 or 0.02
  local far = robot.joints.lift.encoder > height + 0.02
  if builder.lift_to(math.max(0.0002, height - 0.0002), far and 0.05 or slow) then return "tell" end
end

local function tell_state()
  if job.place.row.number then robot.radios.nfc.tx_data({1, job.place.row.number, tonumber(job.payload)}) end
end

-- Tells the block its state, often enough, as it does not hear while it sends. From now on it tells the other
-- robots what may be attached.
function states.tell()
  tell_state()
  if job.seconds() >= 0.5 then return "release" end
end

function states.release()
  tell_state()
  builder.current(math.max(-1, -2 * job.seconds()))
  if job.seconds() > 1 then return "rise" end
end

function states.rise()
  builder.loaded = false
  builder.lift_to(math.min(0.14, height_of_place() + 0.03), 0.05)
  if robot.joints.lift.encoder > height_of_place() + 0.012 then return "back_off" end
end

-- When it is clear of the block, others may come.
function states.back_off()
  if traffic.blocked(-1) and job.seconds() < 20 then return builder.stop() end
  builder.drive(-0.07, 0)
  if builder.ahead() > 0.16 or job.seconds() > 1.2 then traffic.leave_structure() end
  if job.seconds() > 2.3 then
    if not job.place.column then return "scan" end
    memory.attached(job.place)
    return "choose_block"
  end
end

return states
