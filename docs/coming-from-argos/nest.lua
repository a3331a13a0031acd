-- A rule for the world: a grey nest on the floor, and a count of the robots that enter it.

local radius = tonumber(world.params.radius)  -- [m]
local inside, visits = {}, 0

function init()  -- Init() and GetFloorColor()
  inside, visits = {}, 0
  world.floor.paint({x = 0, y = 0, radius = radius}, "gray50")
end

reset = init  -- Reset()

function post_step(tick)  -- PostStep()
  for id, entity in pairs(world.entities) do
    if entity.kind == "foot-bot" then
      local p = entity.position
      local is_inside = math.sqrt(p.x ^ 2 + p.y ^ 2) < radius
      if is_inside and not inside[id] then
        visits = visits + 1
        world.log(id, " enters the nest at tick ", tick)
      end
      inside[id] = is_inside
    end
  end
  world.metric("visits", visits)
end

function is_finished()  -- IsExperimentFinished()
  return visits >= tonumber(world.params.visits)
end
