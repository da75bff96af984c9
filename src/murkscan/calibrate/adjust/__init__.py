"""One adjustment of everything: observations, parameters, priors, residuals, covariance."""
