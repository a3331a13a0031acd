-- A stigmergic block. It is dark until a robot tells it its state when it is placed. From then on it
-- tells its neighbours by radio that it is there, counts the blocks above it, and each side shows by its
-- colour what may be attached there (rules.lua). The script's parameter `rules` names the table; `seed`
-- makes the block the structure's first.
--
-- Messages, by their first byte:
--   1 STATE FRONT    a robot: you are placed, with this state; FRONT (0 to 3) is the side towards me
--   2 STATE HEIGHT   a placed block to its neighbours: this many blocks stand here, with me
--   3 ...            a robot: remember this for me; answered by 4 ... while the block is not placed

local rules = require "rules"

-- A radio that sends does not hear, so blocks send at random ticks.
local often = 0.2   -- probability that a block sends at a tick
local patience = 60 -- ticks after which a neighbour that is not heard is gone

local plan, state, front
local heard, shown, above, memory
local tick

local function place(new_state, new_front)
  state, front = new_state, new_front
  robot.directional_leds.set_all_colors(table.unpack(plan.complete))
  shown = {}
end

function init()
  plan = rules.load(robot.params.rules)
  state, front, memory = nil, nil, nil
  heard, shown, above, tick = {}, {}, 0, 0
  robot.directional_leds.set_all_colors("black")
  if robot.params.seed then place(plan.seed, 0) end
end

function reset() init() end

local function hear(number, message)
  if message[1] == 1 and plan.states[message[2]] then
    place(plan.states[message[2]], message[3] % 4)
  elseif message[1] == 2 then
    heard[number] = tick
    if number == 4 then above = message[3] end
  elseif message[1] == 3 then
    memory = message
  end
end

local function occupied(number) return heard[number] and tick - heard[number] < patience end

local function show()
  for side = 0, 3 do
    local row = plan.row_for(state, 1 + above, (side - front) % 4, occupied(side))
    local color = row and row.shows or plan.complete
    if shown[side] ~= color then
      shown[side] = color
      for led = 4 * side + 1, 4 * side + 4 do
        robot.directional_leds.set_single_color(led, table.unpack(color))
      end
    end
  end
end

function step()
  tick = tick + 1
  for number = 0, 5 do
    for _, message in ipairs(robot.radios["radio_" .. number].rx_data) do hear(number, message) end
  end
  if not occupied(4) then above = 0 end
  local sends = robot.random.bernoulli(often) == 1
  if state then
    show()
    if sends then
      for number = 0, 5 do
        robot.radios["radio_" .. number].tx_data({2, plan.numbers[state], 1 + above})
      end
    end
  elseif memory and sends then
    local answer = {table.unpack(memory)}
    answer[1] = 4
    robot.radios.radio_4.tx_data(answer)
  end
end
