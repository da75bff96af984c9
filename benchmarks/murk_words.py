"""What the page says beside its tables."""

HOW = """\
The simulator's hull (albedo 0.03 to 0.11, at 0.77 to 1.05 m before a wall at 1.35 m), baseline
0.3 m, pictures 5 mm apart from the middle of the hull; each seed has noise, snow and paint of its
own. PAL is interlaced, so that each picture is two frames, and a frame has every second row: its
bound is that of the rows it has. Exposure is fixed for each rung so that the brightest 3 % of the
noise-free stripe, over nine frames, reach 200 grey levels up to c = 3 /m, then 100, 50, 24.
Seeds 0 to 2 are for tuning.

- A true centre is *visible* if its `crlb_px`, the bound of its scan line alone, is at most 0.5
  px. From c = 3 /m on that is the hull without the wall, which is why recall may rise there.
- A found centre is *right* if it is, one to one, the nearest within 1.5 px (of the full frame) of
  a true centre of the line itself in the same frame and scan line. *Recall* is the share of
  visible centres that are found. *Precision* is the share of found ones that are right: a true
  centre that is not visible counts as right when found, a point on the second line that gloss
  throws as false, and so one that the lens's blur carries into a scan line beside its own.
- *Error / bound* is the median of abs(error) / `crlb_px` / 0.6745 where the bound is at most 0.3
  px: 1 is what one scan line allows, and who uses neighbouring ones may pass below. *Bias* is the
  median of the signed error there.
- *Within 1 σ* is the share of errors of visible centres within the sigma told, less 68.3.
- *Posterior, off* is the largest difference between the mean posterior and the observed share of
  right ones, in bins of at least 2000 found centres.
- *Edge in depth*: at jumps of at least 4 px between two smooth visible surfaces, each found
  centre is put between what the two, prolonged, would show (0 and 1); the figure is the way from
  10 to 90 % of the mean, where scan lines without points prolong it. A step has 0.8.
- *Edge of paint*: the same for the height of the stripe, at steps of paint from 0.03 to 0.11 on the
  hull (*c3-paint*, since the growth of the ladder has no steps). The picture's own blur, by lens
  and video, is in it: it alone has {picture:.1f} lines.
- Errors are those of the points that a finder finds: who finds only the clearest has an easy life.
- Means of medians where there are several seeds; all else is counted together."""

WATERS = """\
One thing is changed at a time: *ambient*, daylight that raises the background to some 50 grey
levels; *gloss*, 0.15 on all surfaces; *h264*, kept by H.264 at crf 23 (the bound does not know
of it); *phase*, Henyey-Greenstein with g = 0.9 in place of Petzold's harbour; *skirt*, b/c =
0.95 in place of 0.83; *paint*, bands of 0.03 and 0.11 along the hull in place of growth;
*noise*, 25 e⁻ of reading noise in place of 9.

*traced* has nothing of the simulator: ten frames of a flat wall (albedo 0.2, from 0.72 to 0.88
m), whose light Mitsuba traced (`path_tracer_scene`: 320 × 240 px, a stripe of 4.7 px, 1σ, b/c
0.83, Henyey-Greenstein 0.9, c = 3 /m; {lit} paths a pixel, {black} for the glow before a black
wall). All columns are their mean; what is left of the path tracer's own noise is taken out by a
sum of Gaussians around the true centre for the stripe with its skirt, and a stiff spline for the
glow; noise of the same sensor is added. So it tells whether a finder copes with such water, not
its bias."""

CAUSES = """\
Missed points as a share [%] of the visible ones, false points of the found ones, each under the
first cause that fits. *Jump*: within 3 scan lines of a jump or an end of the stripe; *paint*:
where the albedo changes by 12 % from line to line; else by its bound. *Displaced*: less than 4 px
from a true centre of its scan line; *over an end*: on the stripe of a scan line up to 2 beside
it, whose light the lens has carried over; *second line*: the one that gloss throws; *before the
surface*: in water that the sheet lights, so snow or glow; *elsewhere*: behind the surface, or
where there is none."""

PULL = """\
Median error where the stripe's height changes by more than 8 % from one scan line, or frame, to
the next, counted positive towards the brighter side: along the stripe, where it runs aslant, the
picture's blur mixes in brighter neighbours; across it, the brighter part of the sheet weighs more
(Curless and Levoy 1995). The bound knows neither."""

AFTER = """\
Whole pictures a second of one core (processor's time, one thread, after the loops are compiled),
and that time in units of what murkscan's own reader needs to decode the same file: FFV1, and
H.264 for *h264*.

oplab-pipeline's finder and ridge-detector run in an environment of their own, on every ninth
frame. oplab-pipeline's has its default settings, and 80 columns more on either side, which it
leaves out; ridge-detector (Steger 1998, multi-scale) has one line width of 3 px and contrasts of
5 and 15 grey levels. `find_peaks` asks for a prominence of 10 grey levels and five times the
noise, and a width of 1 to 30 px."""
