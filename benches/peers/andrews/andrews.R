# Time and error of RADAU5 (Hairer and Wanner) on Andrews' squeezing mechanism: one line for each
# tolerance with the tolerance, the largest relative error of the coordinates at t = 0.03 and the
# least time of several runs in seconds. The right side is compiled C; R's deSolve calls it from
# Fortran. Call: Rscript andrews.R library.so
library(deSolve)
file <- commandArgs(trailingOnly = TRUE)[1]
dyn.load(file)
name <- sub("\\.so$", "", basename(file))
start <- c(-0.0617138900142764496358948458001, 0, 0.455279819163070380255912382449,
           0.222668390165885884674473185609, 0.487364979543842550225598953530,
           -0.222668390165885884674473185609, 1.23054744454982119249735015568,
           rep(0, 7), 14222.4439199541138705911625887, -10666.8329399655854029433719415, rep(0, 5),
           98.5668703962410896057654982170, -6.12268834425566265503114393122, rep(0, 4))
end <- c(15.810771195153707, -15.756371058411839, 0.040822240119645805, -0.53473011634207958,
         0.52440996587995407, 0.53473011634207958, 1.0480807410419379)
mass <- diag(c(rep(1, 14), rep(0, 13)))
run <- function(tolerance) {
  radau(start, c(0, 0.03), "derivs", NULL, rtol = tolerance, atol = tolerance, dllname = name,
        initfunc = "start", nout = 0, parms = c(0), mass = mass, massup = NULL, massdown = NULL,
        nind = c(7, 7, 13), maxsteps = 1e6)
}
for (digits in seq(4, 12)) {
  tolerance <- 10^-digits
  least <- Inf
  found <- tryCatch({
    for (k in 1:7) {
      clock <- proc.time()[["elapsed"]]
      for (j in 1:20) found <- run(tolerance)
      least <- min(least, (proc.time()[["elapsed"]] - clock) / 20)
    }
    found[2, 2:8]
  }, warning = function(w) rep(NaN, 7), error = function(e) { message(e); rep(NaN, 7) })
  error <- max(abs(found - end) / abs(end))
  cat(sprintf("%g %.3e %.6f\n", tolerance, error, least))
}
