-- Reads a rule table (rules_*.lua). Blocks and robots read the same table.
--
-- A row says: a column of `height` blocks whose lowest has the state `state` shows the colour `shows` on
-- its `sides` (all, if none are listed), and there a block may be attached: "above" the column, or
-- "before" that side if nothing stands there. The attached block gets the state `becomes`. The first
-- row that fits counts. Sides are "front", "left", "back" and "right": a block's front is the side that
-- looked at the robot that placed it, seen from outside left is at the right hand.

local rules = {}

local side_numbers = {front = 0, left = 1, back = 2, right = 3}

function rules.load(name)
  local rows = require(name)
  local numbers = {[rows.seed] = 1}  -- of the states, by name
  local plan = {rows = rows, seed = rows.seed, complete = rows.complete, states = {rows.seed}, numbers = numbers}
  for index, row in ipairs(rows) do
    row.index = index
    if not numbers[row.becomes] then
      plan.states[#plan.states + 1] = row.becomes
      numbers[row.becomes] = #plan.states
    end
    row.number = numbers[row.becomes]  -- of the state that the attached block gets
  end

  -- A column beside one that shows `row` has got so high that it shows the row that brought the shown one's block;
  -- nil if that is not so for a column of this state.
  function plan.origin_of(row, state)
    for _, origin in ipairs(rows) do
      if origin.place == "before" and origin.becomes == row.state and origin.state == state then return origin end
    end
  end

  -- The row for a side (0 to 3 from the front) of a column; nil if nothing may be attached there.
  function plan.row_for(state, height, side, occupied)
    for _, row in ipairs(rows) do
      if row.state == state and row.height == height and not (row.place == "before" and occupied) then
        if not row.sides then return row end
        for _, name in ipairs(row.sides) do
          if side_numbers[name] == side then return row end
        end
      end
    end
  end

  -- The row that a colour shows; nil if nothing may be attached there.
  function plan.row_shown(color)
    for _, row in ipairs(rows) do
      if row.shows[1] == color.red and row.shows[2] == color.green and row.shows[3] == color.blue then
        return row
      end
    end
  end

  return plan
end

return rules
