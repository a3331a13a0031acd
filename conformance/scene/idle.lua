-- The Lua controller of the conformance scene: it does nothing.
function init() end
function step() end
