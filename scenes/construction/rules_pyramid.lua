-- A stepped pyramid on 3 x 3 columns: three blocks in the centre, two before each of its sides, one at
-- each corner. The corners stand before the sides of the middle columns.

return {
  seed = "centre",
  complete = {255, 255, 255},
  {state = "centre", height = 1, shows = {255, 0, 0}, place = "above", becomes = "upper"},
  {state = "centre", height = 2, shows = {255, 128, 0}, place = "above", becomes = "upper"},
  {state = "centre", height = 3, shows = {0, 255, 0}, place = "before", becomes = "middle"},
  {state = "middle", height = 1, sides = {"front"}, shows = {0, 255, 255}, place = "above",
   becomes = "upper"},
  {state = "middle", height = 2, sides = {"left", "right"}, shows = {0, 0, 255}, place = "before",
   becomes = "corner"},
}
