function init() end
function step() end
