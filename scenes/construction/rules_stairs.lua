-- A staircase: columns of three, two and one block in a row, away from the seed's front.

return {
  seed = "high",
  complete = {255, 255, 255},
  {state = "high", height = 1, shows = {255, 0, 0}, place = "above", becomes = "upper"},
  {state = "high", height = 2, shows = {255, 128, 0}, place = "above", becomes = "upper"},
  {state = "high", height = 3, sides = {"front"}, shows = {0, 255, 0}, place = "before",
   becomes = "middle"},
  {state = "middle", height = 1, sides = {"front"}, shows = {0, 255, 255}, place = "above",
   becomes = "upper"},
  {state = "middle", height = 2, sides = {"front"}, shows = {0, 0, 255}, place = "before",
   becomes = "low"},
}
