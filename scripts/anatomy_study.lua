-- How right the anatomy is: every phantom of anatomy_variants.lua segmented and judged by its own truth.
local p = parameters{
  { name = "matrix", default = 512, range = { 128, 512 }, doc = "Pixels along each side of a slice" },
  { name = "edge", default = "subpixel", choices = { "subpixel", "paper" }, doc = "Where the skin lies: the steepest grey value, or the paper's first pixel" },
  { name = "only", doc = "Name of the one phantom to judge; default: all" },
  { name = "out", default = "anatomy_study", role = "output", doc = "Folder for anatomy_study.csv and anatomy_study.png" },
}
-- Head, figure, format, and what is to be reached in slices of up to 2.5 mm (negative: at least; 0: no goal).
local columns = {
  { "ribs", "ribs_rightly_numbered", "%.0f", -20 }, { "rib RMS", "rib_rms", "%.2f", 1 }, { "worst", "rib_rms_worst", "%.2f", 0 },
  { "cartilage RMS", "cartilage_rms", "%.2f", 1.3 }, { "worst", "cartilage_rms_worst", "%.2f", 0 }, { "sternum", "sternum_mean", "%.2f", 0.7 },
  { "torsion", "torsion_error", "%+.1f", 1.5 }, { "skin", "skin_mean_absolute", "%.3f", 0.15 }, { "pleura", "pleura_mean_absolute", "%.2f", 1 },
  { "Haller", "haller_error", "%+.3f", 0.03 }, { "correction", "correction_index_error", "%+.2f", 1 },
}

local head, csv, goals = string.format("%-24s", "phantom"), "phantom", {}
for _, c in ipairs(columns) do
  goals[#goals + 1] = c[4]
  head = head .. string.format(" %13s", c[1])
  csv = csv .. "," .. c[2]
end
print("Against each phantom's truth: ribs 1-10 rightly numbered of 20; mm but for torsion (degrees), Haller and correction index (found minus true)")
print(head)
local lines = { csv }
for _, variant in ipairs(require "anatomy_variants") do
  if not p.only or p.only == variant.name then
    local settings = { matrix = p.matrix }
    for name, value in pairs(variant) do
      if name ~= "name" then settings[name] = value end
    end
    local ct, truth = loader.phantom(settings)
    local anatomy = segmenter.thorax(ct, { edge = p.edge })
    local figures = comparer.anatomy(anatomy, truth, splines.cartilage(anatomy, ct))
    local row, line = string.format("%-24s", variant.name), variant.name
    for _, c in ipairs(columns) do
      row = row .. string.format(" %13s", string.format(c[3], figures[c[2]]))
      line = line .. string.format(",%.6g", figures[c[2]])
    end
    print(row)
    lines[#lines + 1] = line
  end
end
if #lines == 1 then error("there is no phantom of that name: " .. tostring(p.only)) end
report.table{ path = p.out .. "/anatomy_study.csv", lines = lines }
report.scorecard{ path = p.out .. "/anatomy_study.png", lines = lines, goals = goals, title = "Anatomy against the truth of the phantoms" }
print("The table is in " .. p.out .. "/anatomy_study.csv and .png")
