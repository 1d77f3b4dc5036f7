-- How right the anatomy is: every phantom of anatomy_variants.lua segmented and judged by its own truth.
local p = parameters{
  { name = "matrix", default = 512, range = { 128, 512 }, doc = "Pixels along each side of a slice" },
  { name = "edge", default = "subpixel", choices = { "subpixel", "paper" }, doc = "Where the skin lies: the steepest grey value, or the paper's first pixel" },
  { name = "out", default = "anatomy_study", role = "output", doc = "Folder for anatomy_study.csv" },
}
local columns = {
  { "ribs", "ribs_rightly_numbered", "%.0f" }, { "rib RMS", "rib_rms", "%.2f" }, { "worst", "rib_rms_worst", "%.2f" },
  { "cartilage RMS", "cartilage_rms", "%.2f" }, { "worst", "cartilage_rms_worst", "%.2f" }, { "sternum", "sternum_mean", "%.2f" },
  { "torsion", "torsion_error", "%+.1f" }, { "skin", "skin_mean_absolute", "%.3f" }, { "pleura", "pleura_mean_absolute", "%.2f" },
  { "Haller", "haller_error", "%+.3f" }, { "correction", "correction_index_error", "%+.2f" },
}

local head, csv = string.format("%-24s", "phantom"), "phantom"
for _, c in ipairs(columns) do
  head = head .. string.format(" %13s", c[1])
  csv = csv .. "," .. c[2]
end
print("Against each phantom's truth: ribs 1-10 rightly numbered of 20; mm but for torsion (degrees), Haller and correction index (found minus true)")
print(head)
local lines = { csv }
for _, variant in ipairs(require "anatomy_variants") do
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
report.table{ path = p.out .. "/anatomy_study.csv", lines = lines }
print("The table is in " .. p.out .. "/anatomy_study.csv")
