-- The states in which a robot begins. One that was started again in the middle of its work knows nothing but
-- what it senses: the lift's height, whether it holds a block, and what that block says.

local assembly = require "assembly"
local builder = require "builder"
local traffic = require "traffic"

local job = assembly.job
local states = {}

function states.start()
  if robot.first_tick > 0 then return "sense" end
  builder.current(-1)
  if builder.lift_to(assembly.clearance, 0.05) then return "scan" end
end

-- Nothing moves until it is clear what the robot was at. It may stand at the structure: others stay away.
function states.sense()
  builder.stop()
  traffic.holding = true
  if not builder.holds() then return "withdraw" end
  local height = robot.joints.lift.encoder
  for _, message in ipairs(robot.radios.nfc.rx_data) do
    if message[1] == 2 then  -- the block has been placed, and told so
      job.place = {row = {place = height > 0.03 and "above" or "before",
                          height = math.floor(height / builder.block + 0.5)}}
      return "release"
    end
    if message[1] == 4 then
      job.payload = message[2]
      builder.loaded = true
      builder.current(0)
      if message[3] then  -- it was being placed
        job.place = {row = assembly.plan.rows[message[3]]}
        return "place"
      end
      return "withdraw"
    end
  end
  if job.seconds() > 3 then return "withdraw" end  -- it was just being picked up
end

-- Up, off what is below, and straight back from what is ahead.
function states.withdraw()
  if not builder.loaded then builder.current(-1) end
  if job.seconds() <= builder.tick then
    local height = robot.joints.lift.encoder
    job.height = math.max(height, builder.loaded and assembly.carrying or
                                  math.min(0.14, builder.below() < 0.04 and height + 0.03 or height))
    job.back = nil
  end
  if not builder.lift_to(job.height, 0.03) then return end
  job.back = job.back or (builder.ahead() < 0.3 and 35 or 0)
  if job.back > 0 and not traffic.blocked(-1) then
    job.back = job.back - 1
    builder.drive(-0.05, 0)
    return
  end
  builder.stop()
  if job.back > 0 and job.seconds() < 20 then return end
  traffic.leave_structure()
  return "scan"
end

return states
