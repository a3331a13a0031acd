// What the viewer's own build would have set.
var global = window;
var process = { env: {} };
var FOXGLOVE_STUDIO_VERSION = "1.48.0";
var API_URL = "";
var ReactNull = null;
