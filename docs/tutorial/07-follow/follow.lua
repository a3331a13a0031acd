local radius, side = 0.03, 0.036  -- of a wheel, of the tag [m]
local wanted = 0.3  -- from the tag [m]

local function drive(left, right)  -- [m/s]
  for name, wheel in pairs(robot.joints) do
    wheel.set_target((name:find("left") and left or right) / radius)
  end
end

function init() end

function step()
  local eye = robot.cameras.front
  local tag = eye.tag_detector[1]
  if not tag then return drive(0, 0) end
  local a, b = tag.corners[1], tag.corners[2]
  local size = math.sqrt((a.x - b.x) ^ 2 + (a.y - b.y) ^ 2)  -- [pixels]
  local distance = eye.focal_length.x * side / size
  local right = (tag.center.x - eye.principal_point.x) / eye.focal_length.x
  local speed = 1.5 * (distance - wanted)
  drive(speed + 0.6 * right, speed - 0.6 * right)
end
