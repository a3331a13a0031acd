-- The robot's pose from wheels and gyroscope. The wheels skid in turns, by an amount that changes with the
-- load on each: so the gyroscope measures the turn, and the point about which the robot turns is learned
-- from what the camera sees.

local builder = require "builder"

local odometry = {}

local pivot = {[false] = 0.020, [true] = 0.032}  -- in front of the wheels' middle, by builder.loaded [m]
local turned = 0                                 -- in the last tick [rad]

-- Updates builder.pose; call it first in every step.
function odometry.reckon()
  local joints, pose = robot.joints, builder.pose
  local sum = joints.base_wheel_fl.encoder + joints.base_wheel_bl.encoder +
              joints.base_wheel_fr.encoder + joints.base_wheel_br.encoder
  local way = sum / 4 * builder.wheel_radius * builder.tick
  turned = robot.imus.imu.angular_velocity.z * builder.tick
  local aside = -pivot[builder.loaded] * turned
  local c, s = math.cos(pose.yaw + turned / 2), math.sin(pose.yaw + turned / 2)
  pose.x = pose.x + way * c - aside * s
  pose.y = pose.y + way * s + aside * c
  pose.yaw = pose.yaw + turned
end

-- How far in front of the robot's centre the point is about which it turns [m].
function odometry.ahead() return pivot[builder.loaded] end

-- That point, in the frame of the pose: a turn on the spot does not move it.
function odometry.pivot()
  local pose, forward = builder.pose, pivot[builder.loaded]
  return {x = pose.x + forward * math.cos(pose.yaw), y = pose.y + forward * math.sin(pose.yaw), yaw = pose.yaw}
end

-- Something that stands still was seen this far from its place of the tick before, in the frame of the
-- pose [m].
function odometry.learn(dx, dy)
  if math.abs(turned) < 0.015 then return end
  local aside = -dx * math.sin(builder.pose.yaw) + dy * math.cos(builder.pose.yaw)
  local change = math.max(-0.01, math.min(0.01, aside / turned))
  pivot[builder.loaded] = math.max(0, math.min(0.04, pivot[builder.loaded] + 0.2 * change))
end

return odometry
