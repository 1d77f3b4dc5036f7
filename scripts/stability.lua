-- Every solver through every hard case: what must hold, and what did. Ends with an error if anything broke its rule.
local p = parameters{
  { name = "quick", default = false, doc = "Walls of 7 points a side instead of 15" },
  { name = "only", doc = "Name of one case; random: scenes drawn from the seed" },
  { name = "solver", doc = "Name of one solver" },
  { name = "seed", default = 1, range = { 0, 2e9 }, doc = "Seed of what is left to chance" },
  { name = "scenes", default = 1, range = { 1, 1000000 }, doc = "How many random scenes, with seeds from `seed` on" },
  { name = "brief", default = false, doc = "Print broken rules and counts alone" },
}

-- Rounding of a sum of thousands of energies for minimisers; explicit steps and those of positions keep their energy to a few
-- parts only.
local explicit = { verlet = true, semi_implicit = true }
local ripples = { verlet = true, semi_implicit = true, xpbd = true }
local stepping = { verlet = true, semi_implicit = true, implicit = true, xpbd = true }
local in_time = { verlet = true, semi_implicit = true, implicit = true }
local springs_only = { projective = true, xpbd = true }
local solvers = { { "verlet" }, { "semi_implicit" }, { "implicit" }, { "implicit", "bdf2" }, { "newton" }, { "lbfgs" }, { "projective" }, { "multigrid" }, { "xpbd" } }
local row = "%-22s %-14s %-8s %-10s %9s %9s %8s %7s  %s"
local counts, broken = { converged = 0, told = 0, refused = 0 }, 0

-- What is wrong with a finished motion, or nil.
local function fault(case, name, m)
  for _, figure in ipairs{ m.residual, m.relative_residual, m.energy, m.energy_growth, m.greatest_skin_displacement } do
    if figure ~= figure or math.abs(figure) == math.huge then return "a figure is not finite" end
  end
  local converged, sound = m.status == "converged", m.inverted_prisms == 0
  local isTold = m.status == "diverged" or m.message:find("the energy grew", 1, true)   -- explicit steps may lose hold, but must say so
  if m.energy_growth > (ripples[name] and 0.05 or 1e-10) and not isTold then return "the energy grew" end
  if not converged and m.message == "" then return "no word on what is wrong" end
  if case.must == "refuse" then return "was not refused" end
  if case.must == "flag" and converged and sound then return "passed as sound" end
  if (case.must == "settle" or case.must == "recover") and not (converged and sound) then return "did not come to rest" end
  if case.must == "recover" and m.greatest_skin_displacement > 1e-6 * case.extent then return "did not come back to rest" end
end

local function try(case, s, label)
  local name, scheme = s[1], s[2]
  local settings = { accept_unconverged = true, scheme = scheme, tolerance = case.must == "recover" and 1e-8 or nil }
  if case.time_step > 0 and (explicit[name] or name == "implicit") then settings.time_step = case.time_step end
  if case.load_step > 0 and not stepping[name] then settings.load_step = case.load_step end
  -- Many random scenes: whoever needs longer says so.
  if p.only == "random" then settings.max_iterations = name == "implicit" and 50 or 2000 end
  local ok, m = pcall(solver[name], case.scene, case.plan, case.start, settings)
  local wrong, cells
  if ok then
    wrong = fault(case, name, m)
    local class = m.status == "converged" and m.inverted_prisms == 0 and "converged" or "told"
    counts[class] = counts[class] + 1
    cells = { m.status, ("%.1e"):format(m.energy_growth), ("%.1e"):format(m.relative_residual), ("%d"):format(m.inverted_prisms // 1), ("%.2f"):format(m.seconds), m.message }
  else
    local text = tostring(m):gsub("\n", " ")
    counts.refused = counts.refused + 1
    local may = case.must == "refuse" or case.must == "flag" or (case.time_step > 0 and explicit[name]) or (case.springs_alone == 0 and springs_only[name])
      or (case.in_time == 1 and not in_time[name])
    if not may then wrong = "was refused" end
    if text:find("internal error", 1, true) then wrong = "failed inside" end
    cells = { "refused", "-", "-", "-", "-", text }
  end
  if ok and (case.time_step > 0 and explicit[name] or case.in_time == 1 and not in_time[name]) then wrong = "was not refused" end
  if wrong then broken = broken + 1 end
  if wrong or not p.brief then
    local said = wrong and ("BROKEN: " .. wrong .. "; " .. cells[6]) or cells[6]
    print(row:format(label, scheme and name .. " " .. scheme or name, case.must, cells[1], cells[2], cells[3], cells[4], cells[5], said))
  end
end

local function through(case, label)
  for _, s in ipairs(solvers) do
    if not p.solver or p.solver == s[1] then try(case, s, label) end
  end
end

print(row:format("case", "solver", "must", "status", "growth", "residual", "inverted", "s", "what is said"))
local tried = 0
if p.only == "random" then
  for seed = p.seed // 1, p.seed // 1 + p.scenes // 1 - 1 do
    through(model.hard_case{ name = "random", seed = seed }, ("random, seed=%d"):format(seed))
    tried = tried + 1
  end
else
  local name = p.only or "coincident_pair"
  repeat
    local case = model.hard_case{ name = name, size = p.quick and 7 or 15, seed = p.seed }
    through(case, case.name)
    tried, name = tried + 1, case.next
  until name == "" or p.only
end
print(("%d cases: %d converged, %d told what is wrong, %d refused, %d broke their rule"):format(tried, counts.converged, counts.told, counts.refused, broken))
if broken > 0 then error(("%d runs broke their rule; repeat one with only=CASE solver=NAME seed=%d"):format(broken, p.seed // 1)) end
