# Sets posopt up in .venv on Windows; works in Windows PowerShell 5.1 and in PowerShell 7.
#
#   powershell -ExecutionPolicy Bypass -File scripts\setup.ps1          the program
#   powershell -ExecutionPolicy Bypass -File scripts\setup.ps1 -Test    editable, with the test tools
param([switch]$Test)
$ErrorActionPreference = "Stop"
Set-Location (Split-Path -Parent $PSScriptRoot)

# Returns the command of the first Python that is 3.11 to 3.13.
function Find-Python {
    $check = "import sys, venv; sys.exit(not (3, 11) <= sys.version_info[:2] <= (3, 13))"
    $candidates = @(
        @("py", "-3.13"), @("py", "-3.12"), @("py", "-3.11"), @("python"), @("python3")
    )
    foreach ($candidate in $candidates) {
        if (-not (Get-Command $candidate[0] -ErrorAction SilentlyContinue)) { continue }
        $options = @($candidate | Select-Object -Skip 1)
        # A launcher that lacks the version complains on stderr; that is no reason to stop.
        $ErrorActionPreference = "Continue"
        & $candidate[0] @options -c $check 2>$null | Out-Null
        $found = $LASTEXITCODE -eq 0
        $ErrorActionPreference = "Stop"
        if ($found) { return $candidate }
    }
    [Console]::Error.WriteLine("setup: posopt needs Python 3.11 to 3.13; install it and run this again.")
    exit 1
}

if (-not (Test-Path ".venv\Scripts\python.exe")) {
    $python = @(Find-Python)
    $options = @($python | Select-Object -Skip 1)
    & $python[0] @options -m venv .venv
    if ($LASTEXITCODE -ne 0) { exit $LASTEXITCODE }
}
# What an earlier build left would be packed again.
if (Test-Path "build\lib") { Remove-Item -Recurse -Force "build\lib" }
if ($Test) { $target = @("-e", ".[test]") } else { $target = @(".") }
& .venv\Scripts\python.exe -m pip install --quiet --disable-pip-version-check @target
exit $LASTEXITCODE
