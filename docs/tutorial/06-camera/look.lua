function init() end

function step()
  local eye = robot.cameras.front
  for _, tag in ipairs(eye.tag_detector) do
    local right = (tag.center.x - eye.principal_point.x) / eye.focal_length.x
    log(string.format("tag %s, %.1f degrees to the left", tag.payload, math.deg(math.atan(-right))))
  end
end
