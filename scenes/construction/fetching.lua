-- The states in which a robot fetches a dark block.

local assembly = require "assembly"
local builder = require "builder"
local memory = require "memory"
local odometry = require "odometry"
local traffic = require "traffic"
local travel = require "travel"

local job = assembly.job
local gap = 0.003  -- over the block when the magnets are energised [m]
local states = {}

function states.choose_block()
  job.after_scan = nil
  if not memory.middle() then return "wander" end
  local least
  job.target = nil
  local obstacles = {}
  for _, block in ipairs(memory.material) do
    for _, other in ipairs(memory.obstacles({})) do
      if (other.x - block.x) ^ 2 + (other.y - block.y) ^ 2 > 0.01 ^ 2 then
        obstacles[#obstacles + 1] = other
      end
    end
    if not assembly.taken(block, 0.3) and memory.now > (block.avoid or 0) then
      for side = 0, 3 do
        local face = {yaw = block.yaw + side * math.pi / 2, block = block}
        face.x, face.y = assembly.ahead_of({x = block.x, y = block.y, yaw = face.yaw}, builder.block / 2)
        local x, y = assembly.ahead_of(face, builder.reach + assembly.run_up)
        local cost = assembly.distance_to({x = x, y = y}) + assembly.hindrance(face, obstacles) +
                     assembly.from_middle(block) +  -- those that stand in the way of building first
                     math.min(0.6, 5e-4 * (memory.now - block.seen))  -- somebody may have taken it
        if not least or cost < least then least, job.target = cost, face end
      end
    end
    obstacles = {}
  end
  if job.target then
    job.tries = 0
    return "fetch"
  end
  if job.state ~= "search" then job.points = {} end
  return "search"
end

local function give_up_block(ticks)
  job.target.block.avoid = memory.now + ticks
  return "choose_block"
end

function states.fetch()
  if not memory.is_free(job.target.block) then return "choose_block" end
  if assembly.taken(job.target, 0.3) then return give_up_block(200) end
  local x, y = assembly.ahead_of(job.target, builder.reach + assembly.run_up)
  local outcome = travel.to(x, y)
  if outcome == "there" then return "aim" end
  if outcome or job.seconds() > 90 then return give_up_block(200) end
  builder.lift_to(assembly.clearance, 0.05)
end

function states.aim(faces)
  local face = memory.seen_at(faces, job.target)
  if face then
    if face.color then
      memory.forget(job.target.block)
      return "choose_block"
    end
    job.target.x, job.target.y, job.target.yaw = face.place.x, face.place.y, face.place.yaw
  end
  if travel.turn_to(math.atan(job.target.y - builder.pose.y, job.target.x - builder.pose.x)) then
    if face then return "approach" end
    if job.seconds() > 2.5 then
      memory.forget(job.target.block)
      return "choose_block"
    end
  end
  if job.seconds() > 15 then return give_up_block(200) end
end

function states.approach(faces)
  local face = memory.seen_at(faces, job.target)
  if face then
    job.target.x, job.target.y, job.target.yaw = face.place.x, face.place.y, face.place.yaw
    job.payload = face.payload
  end
  local other = traffic.blocked(1)
  if other then
    builder.stop()
    if job.seconds() > 20 then return give_up_block(200) end
    return
  end
  local outcome = builder.dock_at(assembly.face_of(job.target), 0.06, true, nil, odometry.ahead())
  if outcome == "docked" then return "lower" end
  if outcome == "askew" or job.seconds() > 40 then return "retreat" end
end

-- Back to where the run-up begins.
function states.retreat()
  local may_try = job.retreat(2.5, 4)
  if may_try == false then return give_up_block(600) end
  return may_try and "fetch" or nil
end

-- Whether the block below says that it has been placed.
local function is_placed()
  for _, message in ipairs(robot.radios.nfc.rx_data) do
    if message[1] == 2 then return true end
  end
  return false
end

function states.lower()
  if is_placed() then
    job.target.block.avoid = math.huge
    return "let_go"
  end
  if builder.lift_to(gap - 0.0005, 0.05) then return "energise" end
end

-- The block remembers for the robot which of its sides looks at it.
local function tell_side() robot.radios.nfc.tx_data({3, tonumber(job.payload)}) end

function states.energise()
  tell_side()
  builder.current(math.min(1, -1 + 2 * job.seconds()))
  if job.seconds() > 1.5 then return builder.holds() and "raise" or "let_go" end
end

function states.let_go()
  builder.current(-1)
  if builder.lift_to(assembly.clearance, 0.03) then return "retreat" end
end

function states.raise()
  if builder.lift_to(assembly.carrying, 0.05) then
    builder.current(0)
    builder.loaded = builder.holds()
    if not builder.loaded then return "let_go" end
    memory.forget(job.target.block)
    job.points, job.rounds = {}, 0
    return "choose_side"
  end
  tell_side()
end

return states
