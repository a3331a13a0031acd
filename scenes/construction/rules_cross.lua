-- A small stepped pyramid: a column of two blocks, and one block before each of its four sides.

return {
  seed = "core",
  complete = {255, 255, 255},
  {state = "core", height = 1, shows = {255, 0, 0}, place = "above", becomes = "upper"},
  {state = "core", height = 2, shows = {0, 255, 0}, place = "before", becomes = "arm"},
}
