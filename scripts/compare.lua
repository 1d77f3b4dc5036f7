-- Registration and comparison alone: how far one surface is from another, for anyone with two of them.
local p = parameters{
  { name = "before", role = "input", doc = "The surface to measure against, of triangles: PLY, STL, OBJ or VTK" },
  { name = "after", role = "input", doc = "The surface that is aligned and measured: triangles or points, also FastSCAN text" },
  { name = "landmarks", role = "input", doc = "Landmarks on both: name,ct_x,ct_y,ct_z,scan_x,scan_y,scan_z (ct: before, scan: after); without it they must lie right already" },
  { name = "registration", default = "rigid", choices = { "rigid", "similarity", "affine" }, doc = "How the landmarks are fitted" },
  { name = "icp", default = "yes", choices = { "yes", "no" }, doc = "Align the surfaces themselves after the landmarks, by what they have in common" },
  { name = "before_units", default = "", choices = { "", "mm", "cm", "m", "inch" }, doc = "Unit of before; empty: mm if that is the size of a torso" },
  { name = "after_units", default = "", choices = { "", "mm", "cm", "m", "inch" }, doc = "Unit of after" },
  { name = "max_distance", default = 40, unit = "mm", range = { 0.1, 1000 }, doc = "Points further away have no counterpart" },
  { name = "mode", default = "full", choices = { "full", "paper" }, doc = "paper: every point counts, as in the paper's Table 1" },
  { name = "out", default = "compared", role = "output", doc = "Folder for the results" },
}

local before = scan.file{ path = p.before, units = p.before_units }
local aligned = scan.file{ path = p.after, units = p.after_units }
local landmarks, registration
if p.landmarks then
  aligned, landmarks = register.landmarks(aligned, scan.landmarks{ path = p.landmarks, set = "scan" },
                                          scan.landmarks{ path = p.landmarks, set = "ct" }, { method = p.registration })
  registration = landmarks
end
if p.icp == "yes" then aligned, registration = register.icp(aligned, before) end
local c = comparer.surface(aligned, before, { name = "after_vs_before", max_distance = p.max_distance, mode = p.mode })
report.files{ registration = registration, comparisons = { c }, path = p.out }

if landmarks then print(string.format("landmarks: %s, residual %.2f mm RMS", landmarks.method, landmarks.rms)) end
if p.icp == "yes" then
  print(string.format("ICP: %s after %d iterations, %d points, %.2f mm RMS, held-out points %.2f mm; badly determined: %s, %.3f mm", registration.status,
                      registration.iterations // 1, registration.used_points // 1, registration.rms, registration.held_out_rms,
                      registration.weakest_direction, registration.weakest_sd))
end
local function row(name, prefix)
  print(string.format("%-34s %9d %+9.2f %9.2f %+9.2f %+9.2f", name, c[prefix .. "_points"] // 1, c[prefix .. "_mean"], c[prefix .. "_sd"], c[prefix .. "_min"], c[prefix .. "_max"]))
end
print(string.format("%-34s %9s %9s %9s %9s %9s", "signed distance, mm", "points", "mean", "SD", "min", "max"))
row("after to before, overlap", "overlap")
if c.reverse_overlap_points > 0 then
  row("before to after, overlap", "reverse_overlap")
end
row("every point, as the paper", "paper")
print(string.format("absolute, mm: RMS %.2f, median %+.2f, P95 %.2f", c.overlap_rms, c.overlap_median, c.overlap_p95_absolute))
if c.reverse_overlap_points > 0 then
  print(string.format("both ways, mm: mean %.2f, RMS %.2f, HD95 %.2f, Hausdorff %.2f", c.symmetric_overlap_mean, c.symmetric_overlap_rms, c.symmetric_overlap_hd95, c.symmetric_overlap_hausdorff))
end
print("Results are in " .. p.out)
