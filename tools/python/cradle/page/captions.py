"""What to see in each picture, for a reader who has not run anything; the first sentence of a caption, what the picture
shows, is that of cradle.plot.PICTURES."""

SEE = {
    "shock": "Where the curves of one time cross the whole picture, the rows are passing through each other; where "
             "they turn steep and the density rises, particles pile up. Dashed: place and speed of the first particle "
             "of each row by the theory.",
    "structure": "Each panel enlarges the rectangle of the one before. Distances are sums of the gaps, which have all "
                 "their digits however small they are.",
    "energy": "Above, how the energy falls as collisions take it away, beside the theory if there is one; below, how "
              "many collisions there have been. Where that curve turns upwards sharply, particles collapse.",
    "sticky": "All particles that have met are one: the step between the rows is sharp, and the arrow in the density "
              "grows with the mass that has arrived.",
    "spacetime": "Time runs upwards. Lines that cross have passed through each other, lines that join have stuck; a "
                 "line is the wider the heavier the particle.",
    "zone": "Between the heavy clusters the incoming particles slow down. If the model is right, its lines pass "
            "through the points.",
    "clusters": "The two heavy clusters pass through each other again and again, or stick; the insets divide out how "
                "they grow.",
    "scaling": "A straight line is a power law; the dashed one has the exponent of the theory.",
    "masses": "A straight stretch is a power law of masses; the heaviest clusters are at its lower right end.",
    "cooling": "A flat curve of the ratio to the sticky gas means that the gas cools as the law of that gas says.",
    "field": "Each dot is a particle or cluster. With time few, heavy clusters are left, in a saw-tooth.",
    "beyond": "If the core behaves like sticky particles, the curves of different cut-offs agree.",
    "rates": "If the curves of different cut-offs have one slope, the cut-off decides how often particles collide.",
    "distributions": "The dotted line is that of gaps without any order; what lies above it is order between "
                     "neighbours.",
    "particles": "Where an axis is logarithmic, straight lines are geometric series: each collision shrinks times, "
                 "speeds and gaps by the same factor.",
    "onset": "The part that collapses rises from none to all within a narrow range of particle numbers.",
    "blast": "Points on the lines agree with the exact solution for a continuous gas.",
    "domino": "Points on the line agree with the closed form.",
    "splash": "Straight lines are power laws, with the exponents named.",
    "walls": "Whether the particles stay spread between the walls, or gather at one of them while a few hold the "
             "energy.",
    "averages": "Bars are standard errors; curves whose difference is less than a few bars do not differ.",
    "histograms": "Straight stretches are power laws; a dashed line is the exact result in equilibrium.",
    "correlations": "Where the displacement turns from a parabola to a straight line, particles have begun to "
                    "diffuse.",
    "structure_factor": "Above 1, particles are clustered at that wavelength; below 1, they are spread more evenly "
                        "than at random.",
    "pair_distribution": "Above 1, pairs at that distance are more frequent than at random.",
    "ensemble": "The dark band, often no wider than the line, is the standard error of the mean; the light one spans "
                "all replicas.",
    "profiles": "The dark band is the standard error of the mean; the light one spans all replicas.",
    "collapse": "How much the time of the collapse depends on the random start.",
    "scenarios": "Where the curves leave 0 or 1, chance decides whether the clusters pass or stick.",
    "regimes": "One column for each point, one colour for each outcome.",
    "parameters": "Each panel is one number of the result against what was varied; bars are standard errors over "
                  "replicas.",
    "threshold": "The values tried come closer to the threshold from both sides; blue ones have the outcome of the "
                 "lower end.",
    "words": "A thick bar is where the motion is stable; an open end is not proved.",
    "trust": "A curve that falls shows digits being lost; up to its vertical line a run has made the right "
             "collisions.",
    "certificate": "The proof holds while the bound on the error of a gap, relative to the gap, stays below 0 in this "
                   "logarithm.",
}
