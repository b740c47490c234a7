# Sets everything up and runs the tests on Windows; arguments go to pytest.
$ErrorActionPreference = "Stop"
& (Join-Path $PSScriptRoot "setup.ps1") -Test
if ($LASTEXITCODE -ne 0) { exit $LASTEXITCODE }
Set-Location (Split-Path -Parent $PSScriptRoot)
& .venv\Scripts\python.exe -m pytest @args
exit $LASTEXITCODE
