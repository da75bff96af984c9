"""What the page says beside its tables."""

HOW = """\
Photographs and scans of others, which lie beside the checkout and are in no part of this project;
`real_truth.toml` holds what was drawn into them, and the recipe. Settings of finders may be
fitted on *stage_stairs*, *arm_poses* and the first 31 of the 61 photographs of *green_laser*; all
else is judged only. A finder sees each recording as `murkscan scan` gives it: it learns from 24
frames spread over all of it, and is not told anything else.

- *Where the line is* was drawn by hand: polylines with their ends, and places where the eye
  cannot tell. There is nothing where none is drawn: a point on halo, skirt, glare, a lit edge
  beside the line, a mirrored second line, a chequered square is false.
- *Where a centre lies* within 4 px of the drawing, two finders of two other families than the one
  judged say, if they agree within 1.5 px: centre of mass (gray gravity), ridge (Gaussian,
  Steger), thinning, chain (Murk). A found centre is right within 1.5 px of that, one to one,
  nearest first; where no two agree, within 2.5 px of the drawing; and within 4 to 6 px where the
  band is up to 60 px wide (*arm_poses*, the grazed top of the pyramid).
- *R* is the share of drawn scan lines in which the line is found, *P* the share of all points
  that are right. *Not judged* are points where the eye cannot tell, and three scan lines to
  either side of an end of the line.
- In photographs, the line on the board and on what lies behind it is the line wherever it stands
  out to the eye in the laser's colour. Where green on white is all white to the eye, so that only
  its hue tells, nothing is judged. Finders see what `open_recording` gives: grey levels, and in
  *green_laser*, *arm_poses* and *underwater_line* how much more of the laser's colour there is than
  the other light explains.
- *Along the edge*: false points within 4 px of an end of their scan line.

Photographs of a board that was moved in between are no recording of a dive; they show what a
finder does with daylight, print and edges. Left are the fringes
of bright squares that are not quite white, where lens and sensor part the colours."""

AFTER = """\
Heights are above the plane of the same scan's bed, as depth over travel and row along the
camera's axis (see `real_stage.py`); *scatter* is the median absolute deviation. The recording
*stage_three_levels* begins beyond the lowest level (2.35 mm): its first frame shows the riser
above it, so there are two to measure.

On `steps.png` a piece is found in a scan line where a point lies within 2.5 px of it; *elsewhere*
is all but the five pieces and the faint sixth.

*maximum* and *find-peaks* (with `--peers`) are what users write themselves: the brightest pixel of
a scan line with a centroid around it, and `scipy.signal.find_peaks`."""
