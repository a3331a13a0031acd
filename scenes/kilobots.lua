-- The seed says that it is 0 hops away. The others say one hop more than the least that they hear. The orbiter keeps
-- its distance: where it would get nearer it turns away from the seed, else towards it.

local colors = { [0] = "red", "orange", "yellow", "green", "cyan", "blue", "magenta" }
local unknown = 255
local role = robot.params.role
local last_distance
local hops = role == "seed" and 0 or unknown

local function say(number)
   hops = number
   robot.communication.set_message(number, 0, 0, 0, 0, 0, 0, 0, 0)
   robot.leds.set_all_colors(colors[number % 7])
   if number > 0 then log(robot.id, " is ", number, " hops away") end
end

-- The distance in a second decides: a message comes every half second.
local function orbit(message)
   local soon = message.distance + 2 * (message.distance - (last_distance or message.distance))
   local turns_away = soon < tonumber(robot.params.distance)
   local motors = robot.motors
   motors.set_motors(turns_away and 0 or motors.turn_left, turns_away and motors.turn_right or 0)
   last_distance = message.distance
end

function init()
   if role == "seed" then say(0) end
   if role == "orbiter" then robot.leds.set_all_colors("white") end
end

function step()
   for _, message in ipairs(robot.communication) do
      local of_sender = message.data[1]
      if role == "orbiter" then
         if of_sender == 0 then orbit(message) end
      elseif of_sender + 1 < hops then
         say(math.floor(of_sender) + 1)
      end
   end
end
