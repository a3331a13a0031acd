-- Stacks the first block that it finds on top of the second (section 3.3 of the report).
--
-- A state machine. Its inputs are proximity, camera, radio and joint encoders; it knows no positions.
-- Each state is a function, called at every tick; it returns the name of the next.

local builder = require "construction.builder"

local clearance = 0.03      -- of the end effector's face over a block on the floor, on approach
local gap = 0.003           -- over the block when the magnets are energised
local carrying = builder.block + 0.017  -- lift, with a block carried over another one
local placed = builder.block - 0.0002  -- lift, with the carried block on top of another

local states = {}
local state, since = "start", 0  -- and its age in ticks
local blocks_met = 0

local function seconds() return since * builder.tick end

function states.start()
  builder.current(-1)
  if builder.lift_to(clearance, 0.05) then return "approach" end
end

function states.approach()
  local height = blocks_met == 0 and clearance or carrying
  builder.lift_to(height, 0.05)
  local outcome = builder.dock(0.05)
  if outcome == "docked" then
    blocks_met = blocks_met + 1
    return blocks_met == 1 and "lower" or "place"
  end
  if outcome == "askew" then return "retreat" end
  if outcome == "lost" then return "search" end
end

-- Drives back for another approach.
function states.retreat()
  local away = builder.back_away(0.04)
  if away or seconds() > 10 then
    if not away then builder.forget_face() end
    builder.stop()
    return "approach"
  end
end

-- Turns to both sides, each time farther, until the camera sees a face.
function states.search()
  local turn, length, until_end = 0.2, 2, 2
  while seconds() > until_end do
    turn, length = -turn, 2 * length
    until_end = until_end + length
  end
  builder.drive(0, turn)
  if builder.nearest_face() then
    builder.stop()
    return "approach"
  end
end

function states.lower()
  if builder.lift_to(gap - 0.0005, 0.03) then return "energise" end
end

-- The current rises slowly: before the block jumps, its weight on the floor is less and it aligns.
function states.energise()
  builder.current(math.min(1, -1 + seconds()))
  if seconds() > 2.5 then return builder.holds() and "raise" or "let_go" end
end

function states.raise()
  if builder.lift_to(carrying, 0.03) then return builder.holds() and "signal" or "let_go" end
end

-- Tells the block that it is held. From now on the permanent magnets hold it.
function states.signal()
  builder.current(0)
  robot.radios.nfc.tx_data({1})
  if seconds() >= 1 then return "leave_gap" end
end

-- The first block is lifted; look for the next.
function states.leave_gap()
  if builder.nearest_face() then return "approach" end
  builder.drive(0.03, 0)
  if seconds() > 3 then
    builder.stop()
    return "search"
  end
end

function states.let_go()
  builder.current(-1)
  builder.lift_to(clearance, 0.03)
  if seconds() > 3 then
    blocks_met = 0
    return "retreat"
  end
end

-- Slowly: the carried block pulls the lower one, which aligns under it.
function states.place()
  if builder.lift_to(placed, 0.008) then return "release" end
end

function states.release()
  builder.current(math.max(-1, -2 * seconds()))
  if seconds() > 1.5 then return "rise" end
end

function states.rise()
  if builder.lift_to(carrying + 0.02, 0.02) then return "back_off" end
end

function states.back_off()
  builder.drive(-0.04, 0)
  if seconds() > 2.5 then return "done" end
end

function states.done() builder.stop() end

function init() log("start") end

function step()
  since = since + 1
  local next_state = states[state]()
  if next_state then
    state, since = next_state, 0
    log(state)
  end
  builder.move_lift()
end

function reset()
  state, since, blocks_met = "start", 0, 0
end
