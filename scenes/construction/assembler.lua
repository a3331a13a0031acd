-- A robot that builds, with any number of others, what a rule table says (the script's parameter
-- `rules`). It knows neither positions nor the plan's progress: the colour of a column's side says what
-- may be attached there (rules.lua). Dark blocks are material.
--
-- A state machine. Each state is a function, called at every tick; it returns the name of the next.

local assembly, builder, memory, odometry, traffic, travel, job
local scan_rate = 0.7  -- rad/s
local states = {}

function states.scan()
  if job.seconds() <= builder.tick then job.turned = 0 end
  travel.spin(scan_rate)
  job.turned = job.turned + scan_rate * builder.tick
  if job.turned > 2 * math.pi + 0.3 then
    travel.wait()
    return job.after_scan or assembly.decide()
  end
end

-- No lit block was ever seen: looks from somewhere else. Around the places of the dark blocks that it saw, at
-- first near their middle, then farther out.
function states.wander()
  if memory.middle() then return assembly.decide() end
  if job.seconds() <= builder.tick then
    local x, y, count = 0, 0, 0
    for _, block in ipairs(memory.material) do x, y, count = x + block.x, y + block.y, count + 1 end
    if count > 0 then x, y = x / count, y / count end
    local direction = robot.random.uniform(-math.pi, math.pi)
    local radius = 0.1 + 0.15 * job.rounds
    job.rounds = job.rounds < 6 and job.rounds + 1 or 0
    job.wander_to = {x = x + radius * math.cos(direction), y = y + radius * math.sin(direction)}
  end
  if travel.to(job.wander_to.x, job.wander_to.y) or job.seconds() > 30 then return "scan" end
end

-- Looks for material from places around the structure. When it finds neither material nor a side that
-- waits for some, the structure is complete.
function states.search()
  if #memory.material > 0 then
    local chosen = states.choose_block()
    if chosen == "fetch" then return chosen end
  end
  if #job.points == 0 then
    job.rounds = job.rounds + 1
    if job.rounds > 4 or (job.rounds > 1 and #memory.open_sides(900) == 0) then return "park" end
    job.points = assembly.ring(assembly.search_ring, 5)
  end
  if assembly.go_to_ring(job.points[1]) or job.seconds() > 40 then
    table.remove(job.points, 1)
    job.after_scan = "search"
    return "scan"
  end
end

-- Whether no dark block is remembered under or near the one that the robot carries.
local function is_free()
  for _, block in ipairs(memory.material) do
    if assembly.distance_to(block) < 0.25 then return false end
  end
  return true
end

function states.park()
  local middle = memory.middle()
  if not job.points[1] or not job.points[1].parking then
    job.points = assembly.ring(assembly.parking_ring, 12)
    job.points[1].parking = true
  end
  local x = middle.x + job.points[1].radius * math.cos(job.points[1].angle)
  local y = middle.y + job.points[1].radius * math.sin(job.points[1].angle)
  if assembly.taken({x = x, y = y}, 0.35) then
    table.remove(job.points, 1)
    if job.points[1] then job.points[1].parking = true end
    return
  end
  local outcome = travel.to(x, y)
  if outcome == "there" and builder.loaded and is_free() then return "put_down" end
  if outcome == "there" or job.seconds() > 90 then return "done" end
end

-- A block that is left over goes back to the floor.
function states.put_down()
  if builder.lift_to(0.0002, 0.02) then return "let_left_over_go" end
end

function states.let_left_over_go()
  builder.current(math.max(-1, -2 * job.seconds()))
  if job.seconds() < 1.5 then return end
  builder.loaded = false
  if builder.lift_to(assembly.clearance, 0.03) then
    builder.drive(-0.05, 0)
    if job.seconds() > 6 then return "done" end
  end
end

function states.done() builder.stop() end

-- In these others keep out of the robot's way.
local working = {}
for _, name in ipairs({"approach", "retreat", "lower", "energise", "let_go", "raise", "attach",
                       "retreat_from_side", "place", "tell", "release", "rise", "back_off", "sense", "withdraw"}) do
  working[name] = true
end

-- Loads what keeps variables from tick to tick anew: a robot that begins knows nothing.
local function begin()
  for _, name in ipairs({"assembly", "builder", "corridor", "fetching", "memory", "odometry", "placing", "starting",
                         "traffic", "travel"}) do
    package.loaded[name] = nil
  end
  assembly, builder, memory = require "assembly", require "builder", require "memory"
  odometry, traffic, travel = require "odometry", require "traffic", require "travel"
  job = assembly.job
  for _, name in ipairs({"starting", "fetching", "placing"}) do
    for state, act in pairs(require(name)) do states[state] = act end
  end
end

function init()
  begin()
  log("start")
end

reset = init

function step()
  job.since = job.since + 1
  odometry.reckon()
  traffic.sense()
  local faces = builder.faces()
  memory.update(faces, traffic.others)
  local next_state = states[job.state](faces)
  if next_state then
    if next_state ~= job.state then log(next_state) end
    job.state, job.since = next_state, 0
    travel.forget()
  end
  traffic.working = working[job.state] or false
  traffic.tell()
  traffic.stopped = false
  builder.move_lift()
end
