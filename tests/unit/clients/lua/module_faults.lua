-- Errors are Lua errors with a message: module_faults.lua ENDPOINT (of the vehicle's scene)
local ziggurat = require "ziggurat"

local function fails(with, ...)
   local ok, message = pcall(...)
   assert(not ok, "no error: " .. with)
   assert(message:find(with, 1, true), message)
end

fails("endpoint must be a string", ziggurat.connect, {endpoint = 3})
fails("unknown option 'foo'", ziggurat.connect, {endpoint = "tcp://127.0.0.1:1", foo = 1})
fails("options must have names", ziggurat.connect, {"tcp://127.0.0.1:1"})
fails("robots[2] must be a string", ziggurat.connect, {endpoint = "tcp://127.0.0.1:1", robots = {"a", 1}})
fails("connect_timeout must be a number", ziggurat.connect, {endpoint = "x", connect_timeout = -1})
fails("no server of this user", ziggurat.connect)
fails("not an endpoint", ziggurat.connect, {endpoint = "nonsense"})
fails("no-server", ziggurat.connect, {endpoint = "ipc://@no-server", connect_timeout = 0.05})
fails("unknown", ziggurat.connect, {endpoint = arg[1], robots = "unknown"})

local session = ziggurat.connect{endpoint = arg[1], robots = "vehicle"}
fails("vehicle", ziggurat.connect, {endpoint = arg[1]}) -- it is taken
assert(session:next() == 0)
local joint = session.robots.vehicle.joints.base_wheel_fl
fails("number", joint.set_target, "1")
fails("finite", joint.set_target, 0 / 0)
fails("fail(message)", session.robots.vehicle.fail)

-- Functions may outlive the session that they came from.
local kept = {joint.set_target, session.next, session.robots.vehicle.log}
session:close("that was enough")
session, joint = nil, nil
collectgarbage()
kept[1](2)
assert(kept[2]() == nil)
kept[3]("too late")
